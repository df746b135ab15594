"""Icons, emoji and logos with color gradients, from npm, drawn by resvg, to be scored as flat ones are.

    gradients.py REAL.PY DIR [--seed N] [--each N]     # DIR/truth/SET/NAME.svg, DIR/src/SET/SIZE/NAME.png
    REAL.PY run DIR --dvp EXE --sizes 256 --peers; REAL.PY score DIR --sizes 256

Two sets of emoji and two of logos, as Iconify packs them. Taken are those that name a gradient, and no picture, filter, text or mask. Nobody
debugs on the pictures of the seed that is the default.
"""

import argparse
import json
import pathlib
import random
import re

from labelled import load

SEED = 864_209
SIZES = [256]
SETS = {"noto": "1.2.9", "fluent-emoji": "1.2.7", "logos": "1.2.19", "devicon": "1.2.68"}
TAKEN = re.compile("<(linear|radial)Gradient")
LEFT = re.compile("<(image|filter|text|mask)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("script")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--each", type=int, default=20)
    given = parser.parse_args()
    folder, jobs = given.folder.absolute(), []
    real = load(given.script)
    real.tools(str(folder), [f"@iconify-json/{name}@{version}" for name, version in SETS.items()])
    for name in SETS:
        pack = json.loads((folder / f"node_modules/@iconify-json/{name}/icons.json").read_text())
        bodies = {key: icon for key, icon in pack["icons"].items() if TAKEN.search(icon["body"]) and not LEFT.search(icon["body"])}
        truth = folder / "truth" / name
        truth.mkdir(parents=True, exist_ok=True)
        for key in random.Random(f"{given.seed} {name}").sample(sorted(bodies), min(given.each, len(bodies))):
            icon = bodies[key]
            box = [icon.get("left", 0), icon.get("top", 0), icon.get("width", pack.get("width", 16)), icon.get("height", pack.get("height", 16))]
            svg = ('<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
                   f'viewBox="{" ".join(map(str, box))}">{icon["body"]}</svg>')
            (truth / f"{key}.svg").write_text(svg)
            jobs += [dict(src=f"{truth}/{key}.svg", out=f"{folder}/src/{name}/{width}/{key}.png", width=width)
                     for size in SIZES for width in (size, 4 * size)]
    (folder / "sets.json").write_text(json.dumps({name: {} for name in SETS}))
    real.draw(str(folder), jobs)


if __name__ == "__main__":
    main()
