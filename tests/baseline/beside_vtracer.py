"""Photographs, which are no drawings, and codes of square modules: ours beside VTracer's.

    beside_vtracer.py DIR --dvp EXE [--seed N]     # makes an environment in DIR/venv, the pictures, their drawings, and two tables

*Photographs*: five that packages of PyPI bring along (scikit-learn: a temple, a flower; matplotlib: a portrait; PyWavelets: a bridge and stairs, both
gray), at 256 and 512 pixels on the longer side. *Codes*: QR codes of twelve random texts of 10 to 200 letters (`segno`), with modules of 1, 3 and 8
pixels, and with modules of 3 pixels beside a disk without smooth edges.

Both drawings are drawn by resvg (`@resvg/resvg-js`, from npm) as large as the picture. *MAE*: mean absolute difference of a channel, of 1; *bad*: share
of the pixels with a channel off by more than .1; *things*: objects of ours, paths of VTracer; *bytes* of the SVG; *s*: time of the whole process, and of
VTracer's call. Nobody debugs on these photographs, nor on the codes of the seed that is the default.
"""

import argparse
import json
import pathlib
import random
import string
import subprocess
import sys
import time

PACKAGES = ["numpy", "pillow", "vtracer==0.6.15", "scikit-learn", "matplotlib", "pywavelets", "segno"]
SIZES = [256, 512]
SEED = 771_204
CODES = 12


def photographs():
    import matplotlib
    import numpy as np
    import pywt.data
    from PIL import Image
    from sklearn.datasets import load_sample_images

    temple, flower = load_sample_images().images
    portrait = pathlib.Path(matplotlib.get_data_path()) / "sample_data/grace_hopper.jpg"
    gray = lambda values: Image.fromarray(np.asarray(values, dtype=np.uint8)).convert("RGB")
    return {
        "temple": Image.fromarray(temple),
        "flower": Image.fromarray(flower),
        "portrait": Image.open(portrait).convert("RGB"),
        "bridge": gray(pywt.data.aero()),
        "stairs": gray(pywt.data.ascent()),
    }


def codes(seed):
    """Each code by its kind and number."""
    import numpy as np
    import segno
    from PIL import Image, ImageDraw

    draw_from = random.Random(seed)
    for number in range(CODES):
        text = "".join(draw_from.choices(string.ascii_letters + string.digits + " ", k=draw_from.randint(10, 200)))
        modules = np.pad(np.array([list(row) for row in segno.make(text, micro=False).matrix], dtype=np.uint8), 4)
        shown = {side: Image.fromarray(np.kron(255 * (1 - modules), np.ones((side, side), np.uint8))).convert("RGB") for side in (1, 3, 8)}
        for side, code in shown.items():
            yield f"{number}_{side}px", code
        color = lambda: tuple(draw_from.randrange(256) for _ in range(3))
        poster = Image.new("RGB", (shown[3].width + 160, shown[3].height + 40), color())
        x, y = shown[3].width + 90, draw_from.randrange(60, shown[3].height - 20)
        ImageDraw.Draw(poster).ellipse((x - 45, y - 45, x + 45, y + 45), fill=color())
        poster.paste(shown[3], (15, 20))
        yield f"{number}_poster", poster


DRAW = """const {Resvg}=require('@resvg/resvg-js');const fs=require('fs');
for(const {src,out,width} of JSON.parse(fs.readFileSync(process.argv[2])))
fs.writeFileSync(out,new Resvg(fs.readFileSync(src,'utf8'),{fitTo:{mode:'width',value:width}}).render().asPng())"""


def draw(folder, jobs):
    if not (folder / "node_modules/@resvg/resvg-js").exists():
        (folder / "package.json").write_text("{}")
        subprocess.run(["npm", "install", "--silent", "--no-audit", "--no-fund", "@resvg/resvg-js@2.6.2"], cwd=folder, check=True)
    (folder / "draw.cjs").write_text(DRAW)
    (folder / "jobs.json").write_text(json.dumps(jobs))
    subprocess.run(["node", "draw.cjs", "jobs.json"], cwd=folder, check=True)


def pictures(folder, seed):
    """Paths of all pictures, each with the row of the tables that it counts in."""
    for name, photograph in photographs().items():
        for size in SIZES:
            small = photograph.copy()
            small.thumbnail((size, size))
            small.save(folder / f"{name}_{size}.png")
            yield folder / f"{name}_{size}.png", f"photographs {size}"
    for name, code in codes(seed):
        code.save(folder / f"code_{name}.png")
        yield folder / f"code_{name}.png", f"codes {name.split('_')[1]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--dvp", type=pathlib.Path, required=True)
    parser.add_argument("--seed", type=int, default=SEED)
    given = parser.parse_args()
    folder, exe = given.folder.absolute(), given.dvp.absolute()
    home = folder / "venv"
    if pathlib.Path(sys.prefix).resolve() != home.resolve():
        if not home.exists():
            subprocess.run([sys.executable, "-m", "venv", home], check=True)
            subprocess.run([home / "bin/python", "-m", "pip", "install", "-q", *PACKAGES], check=True)
        return subprocess.run([home / "bin/python", __file__, folder, "--dvp", exe, "--seed", str(given.seed)]).returncode

    import numpy as np
    import vtracer
    from PIL import Image

    jobs, rows = [], []
    for picture, row in pictures(folder, given.seed):
        start = time.perf_counter()
        subprocess.run([exe, "fit", picture, "--out", folder / "dvp", "--threads", "1", "--no-png"], check=True, stdout=subprocess.DEVNULL)
        ours = time.perf_counter() - start
        start = time.perf_counter()
        vtracer.convert_image_to_svg_py(str(picture), str(picture.with_suffix(".vtracer.svg")))
        theirs = time.perf_counter() - start
        width = Image.open(picture).width
        drawings = [("dvp", folder / f"dvp/{picture.stem}.svg", ours), ("vtracer", picture.with_suffix(".vtracer.svg"), theirs)]
        for program, svg, seconds in drawings:
            out = str(picture.with_suffix(f".{program}.drawn.png"))
            jobs.append({"src": str(svg), "out": out, "width": width})
            rows.append((row, picture, program, svg, seconds, out))
    draw(folder, jobs)
    means = {}
    for row, picture, program, svg, seconds, out in rows:
        shown, drawn = (np.asarray(Image.open(path).convert("RGB"), dtype=float) / 255 for path in (picture, out))
        off = np.abs(shown - drawn[: shown.shape[0], : shown.shape[1]])
        text = svg.read_text()
        things = sum(text.count(f"<{kind} ") for kind in ("path", "rect", "circle", "ellipse", "polygon")) - (program == "dvp")
        scores = [off.mean(), 100 * (off.max(-1) > 0.1).mean(), things, len(text), seconds]
        means.setdefault((row, program), []).append(scores)
    print("pictures | program | MAE | bad % | things | bytes | s")
    for (row, program), values in means.items():
        print(f"{row}, mean of {len(values)} | {program} | " + " | ".join(f"{value:.4g}" for value in np.mean(values, axis=0)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
