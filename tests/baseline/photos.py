"""Photographs, which are no drawings, as regions of one color: ours beside VTracer's.

    photos.py DIR --dvp EXE  # makes an environment in DIR/venv, the pictures, their drawings, and a table

Five photographs that packages of PyPI bring along (scikit-learn: a temple, a flower; matplotlib: a portrait; PyWavelets: a bridge and stairs, both gray),
at 256 and 512 pixels on the longer side. Both drawings are drawn by resvg (`@resvg/resvg-js`, from npm) as large as the picture. *MAE*: mean absolute
difference of a channel, of 1; *bad*: share of the pixels with a channel off by more than .1; *things*: objects of ours, paths of VTracer; *bytes* of
the SVG; *s*: time of the whole process, and of VTracer's call. Nobody debugs on these.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import time

PACKAGES = ["numpy", "pillow", "vtracer==0.6.15", "scikit-learn", "matplotlib", "pywavelets"]
SIZES = [256, 512]


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


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--dvp", type=pathlib.Path, required=True)
    given = parser.parse_args()
    folder = given.folder.absolute()
    home = folder / "venv"
    if pathlib.Path(sys.prefix).resolve() != home.resolve():
        if not home.exists():
            subprocess.run([sys.executable, "-m", "venv", home], check=True)
            subprocess.run([home / "bin/python", "-m", "pip", "install", "-q", *PACKAGES], check=True)
        return subprocess.run([home / "bin/python", __file__, folder, "--dvp", given.dvp.absolute()]).returncode

    import numpy as np
    import vtracer
    from PIL import Image

    jobs, rows = [], []
    for name, photograph in photographs().items():
        for size in SIZES:
            stem = folder / f"{name}_{size}"
            small = photograph.copy()
            small.thumbnail((size, size))
            small.save(f"{stem}.png")
            start = time.perf_counter()
            subprocess.run([given.dvp, "fit", f"{stem}.png", "--out", folder / "dvp", "--threads", "1"], check=True, stdout=subprocess.DEVNULL)
            ours = time.perf_counter() - start
            start = time.perf_counter()
            vtracer.convert_image_to_svg_py(f"{stem}.png", f"{stem}.vtracer.svg")
            theirs = time.perf_counter() - start
            drawings = [("dvp", folder / f"dvp/{stem.name}.svg", ours), ("vtracer", pathlib.Path(f"{stem}.vtracer.svg"), theirs)]
            for program, svg, seconds in drawings:
                out = f"{stem}.{program}.drawn.png"
                jobs.append({"src": str(svg), "out": out, "width": small.width})
                rows.append((f"{stem}.png", program, svg, seconds, out))
    draw(folder, jobs)
    print("picture | program | MAE | bad % | things | bytes | s")
    means = {}
    for picture, program, svg, seconds, out in rows:
        shown, drawn = (np.asarray(Image.open(path).convert("RGB"), dtype=float) / 255 for path in (picture, out))
        off = np.abs(shown - drawn[: shown.shape[0], : shown.shape[1]])
        text = svg.read_text()
        things = sum(text.count(f"<{kind} ") for kind in ("path", "rect", "circle", "ellipse", "polygon")) - (program == "dvp")
        row = [off.mean(), 100 * (off.max(-1) > 0.1).mean(), things, len(text), seconds]
        means.setdefault((pathlib.Path(picture).stem.split("_")[1], program), []).append(row)
        print(f"{pathlib.Path(picture).stem} | {program} | " + " | ".join(f"{value:.4g}" for value in row))
    for (size, program), values in sorted(means.items()):
        print(f"mean {size} | {program} | " + " | ".join(f"{value:.4g}" for value in np.mean(values, axis=0)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
