"""Traces the pictures of `dvp parsimony` with VTracer (its defaults), for `dvp parsimony --traced`.

    pip install vtracer pillow resvg-py
    python tests/report/trace_pictures.py DIR/pictures SVG_DIR

Prints the mean absolute error of the drawings against the pictures (8 bits), if resvg-py is there.
"""

import io
import sys
from pathlib import Path

import vtracer


def error(svg: Path, png: Path) -> float:
    """Mean absolute difference of all channels, 0 to 1."""
    import resvg_py
    from PIL import Image, ImageChops, ImageStat

    drawn = Image.open(io.BytesIO(bytes(resvg_py.svg_to_bytes(svg_path=str(svg))))).convert("RGB")
    difference = ImageChops.difference(drawn, Image.open(png).convert("RGB"))
    return sum(ImageStat.Stat(difference).mean) / 3 / 255


def main() -> None:
    pictures, out = Path(sys.argv[1]), Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    errors = []
    for png in sorted(pictures.glob("*.png")):
        svg = out / f"{png.stem}.svg"
        vtracer.convert_image_to_svg_py(str(png), str(svg))
        try:
            errors.append(error(svg, png))
        except ImportError:
            continue
    print(f"{len(list(out.glob('*.svg')))} drawings in {out}")
    if errors:
        print(f"mean absolute error {sum(errors) / len(errors):.2e}")


if __name__ == "__main__":
    main()
