"""Pictures that something happened to after they were drawn: noise, blur, scaling, sharpening, coders of photographs.

Sources: icons, flags and emoji of the set `real` at 256 px, every EVERY-th of each package. What is found is drawn from its SVG, sharp, and
held against the picture before it was spoiled: `mae`, and `bad`, the share of the pixels that are off by more than a quarter of the scale (%).
The first row is the picture as it was.
"""

import io
import pathlib
import subprocess
import zlib

import numpy as np
from PIL import Image, ImageFilter

EVERY = 8
OFF = 0.25
SEED = 641_908_533


def coded(picture, kind, quality):
    """The pixels that a coder leaves, as a file that does not say so."""
    file = io.BytesIO()
    picture.save(file, kind, quality=quality)
    return Image.open(io.BytesIO(file.getvalue())).convert("RGB")


def noisy(picture, deviation, stem):
    """Gaussian noise; `deviation` as a share of white."""
    pixels = np.asarray(picture, np.float64)
    noise = np.random.default_rng([SEED, zlib.crc32(stem.encode())]).normal(0, 255 * deviation, pixels.shape)
    return Image.fromarray(np.clip(np.rint(pixels + noise), 0, 255).astype(np.uint8))


def enlarged(picture, how):
    """Half the size, averaged, and back."""
    return picture.resize([side // 2 for side in picture.size], Image.BOX).resize(picture.size, how)


blurred = lambda picture, radius: picture.filter(ImageFilter.GaussianBlur(radius))
KINDS = {
    "as drawn": lambda picture, stem: picture,
    "noise 0.02": lambda picture, stem: noisy(picture, 0.02, stem),
    "noise 0.08": lambda picture, stem: noisy(picture, 0.08, stem),
    "blur 0.5 px": lambda picture, stem: blurred(picture, 0.5),
    "blur 1 px": lambda picture, stem: blurred(picture, 1),
    "blur 2 px": lambda picture, stem: blurred(picture, 2),
    "blur 0.7 px, noise 0.02": lambda picture, stem: noisy(blurred(picture, 0.7), 0.02, stem),
    "twice enlarged, bilinear": lambda picture, stem: enlarged(picture, Image.BILINEAR),
    "twice enlarged, bicubic": lambda picture, stem: enlarged(picture, Image.BICUBIC),
    "twice enlarged, pixels repeated": lambda picture, stem: enlarged(picture, Image.NEAREST),
    "sharpened": lambda picture, stem: picture.filter(ImageFilter.UnsharpMask(1, 80, 0)),
    "JPEG 80 saved as PNG": lambda picture, stem: coded(picture, "JPEG", 80),
    "WebP 80 saved as PNG": lambda picture, stem: coded(picture, "WEBP", 80),
}


def opaque(path):
    """A picture over white."""
    picture = Image.open(path).convert("RGBA")
    white = Image.new("RGBA", picture.size, "white")
    white.alpha_composite(picture)
    return white.convert("RGB")


def spoiled(place):
    """Copies of real pictures after something happened to them."""
    source = place.work / "real/src"
    paths = [p for folder in sorted(source.glob("*/256")) for p in sorted(folder.glob("*.png"))[::EVERY]]
    if not paths:
        return place.skip("spoiled", f"{source} is not there: the set `real` makes it")
    root = place.work / "spoiled"
    clean = {f"{p.parent.parent.name}_{p.stem}": opaque(p) for p in place.some(paths)}
    for kind, spoil in KINDS.items():
        folder = root / kind.replace(" ", "_").replace(",", "")
        folder.mkdir(parents=True, exist_ok=True)
        for stem, picture in clean.items():
            if not (folder / f"{stem}.png").exists():
                spoil(picture, stem).save(folder / f"{stem}.png")
        name = f"spoiled, {kind}"
        out, fits = place.fit(name, [folder / f"{stem}.png" for stem in clean], drawn=True)
        yield name, {stem: score(place, picture, out / stem, fits.get(stem, {})) for stem, picture in clean.items()}


def score(place, clean, found, fit):
    """How far a drawing is from the picture before it was spoiled; all off where there is none."""
    svg, png = pathlib.Path(f"{found}.svg"), pathlib.Path(f"{found}.sharp.png")
    if svg.exists():
        size = ["--width", str(clean.width), "--height", str(clean.height)]
        subprocess.run([place.dvp, "render", svg, "-o", png, *size], capture_output=True)
    if not png.exists():
        return dict(mae=1.0, bad=100.0)
    off = np.abs(np.asarray(opaque(png), float) - np.asarray(clean, float)) / 255
    return dict(mae=float(off.mean()), bad=float(100 * (off.max(2) > OFF).mean()), ms=fit.get("ms"), objects=fit.get("fitted"))
