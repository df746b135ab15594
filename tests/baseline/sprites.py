"""Sprites: pixel art drawn from a seed, as it is, four times and eight times enlarged by repeating pixels.

    sprites.py DIR SEED COUNT       # others, to look at

*Creatures* have an outline one pixel wide, two shades, patches and eyes, mirrored; *tiles* fill squares of 4 pixels; *items* are ellipses,
triangles, boxes and lines without smooth edges. What is found is drawn from its SVG at eight times the size of the sprite and held against its
squares: `mae`, and `bad`, the share of the pixels that are off by more than a quarter of the scale (%).
"""

import pathlib
import sys

import numpy as np
from PIL import Image, ImageDraw

from spoiled import score

SEED = 5_520_931
COUNT = 12
TIMES = (1, 4, 8)
SCORED_AT = 8


def smooth(field, rounds):
    """Each value averaged with its four neighbors."""
    for _ in range(rounds):
        field = (field + sum(np.roll(field, by, axis) for by in (1, -1) for axis in (0, 1))) / 5
    return field


def mirrored(rng, side, rounds):
    """A smooth field of unit deviation, the same on the left and on the right."""
    field = smooth(rng.normal(size=(side, side)), rounds)
    field = field + field[:, ::-1]
    return field / field.std()


def creature(rng):
    side = int(rng.choice([16, 24, 32, 48]))
    y, x = np.mgrid[:side, :side] + 0.5
    height = 0.35 * mirrored(rng, side, 3) + 1 - 2.5 * np.hypot(x - side / 2, y - side / 2) / side
    body = height > 0.15
    inner = body & np.all([np.roll(body, by, axis) for by in (1, -1) for axis in (0, 1)], axis=0)
    skin, outline, patch, ground = rng.integers(0, 256, (4, 3))
    pixels = np.full((side, side, 3), ground)
    pixels[body] = outline
    pixels[inner] = skin
    pixels[inner & (mirrored(rng, side, 2) > 0.8)] = patch
    pixels[inner & (height < 0.45) & (x > side / 2)] = 0.7 * skin
    eye = [side // 2 - 1 - side // 8, side // 10]
    pixels[eye[0], [side // 2 - 1 - eye[1], side // 2 + eye[1]]] = 255
    return Image.fromarray(pixels.astype(np.uint8))


def tiles(rng):
    palette = rng.integers(0, 256, (6, 3))
    cells = palette[np.where(rng.random((6, 6)) < 0.5, 0, rng.integers(1, 6, (6, 6)))]
    return Image.fromarray(cells.repeat(4, 0).repeat(4, 1).astype(np.uint8))


def items(rng):
    color = lambda: tuple(map(int, rng.integers(0, 256, 3)))
    picture = Image.new("RGB", (32, 32), color())
    pen = ImageDraw.Draw(picture)
    for kind in rng.permutation(4):
        (left, top), (width, height) = rng.integers(1, 20, 2).tolist(), rng.integers(6, 14, 2).tolist()
        right, bottom = left + width, top + height
        if kind == 0:
            pen.ellipse([left, top, right, bottom], fill=color())
        elif kind == 1:
            pen.polygon([(left, bottom), (right, bottom), ((left + right) // 2, top)], fill=color())
        elif kind == 2:
            pen.rectangle([left, top, right, bottom], fill=color())
        else:
            pen.line([left, top, right, bottom], fill=color(), width=int(rng.integers(1, 3)))
    return picture


KINDS = {"creature": creature, "tiles": tiles, "items": items}


def drawn(seed, count):
    """Sprites by name, `count` of each kind."""
    return {f"{name}_{k}": draw(np.random.default_rng([seed, number, k]))
            for number, (name, draw) in enumerate(KINDS.items()) for k in range(count)}


def repeated(picture, times):
    return picture.resize([side * times for side in picture.size], Image.NEAREST)


def sprites(place):
    """Pixel art, enlarged or not, against its squares."""
    pictures = drawn(SEED, 2 if place.is_quick else COUNT)
    for times in TIMES:
        folder = place.work / f"sprites/{times}"
        folder.mkdir(parents=True, exist_ok=True)
        for stem, picture in pictures.items():
            repeated(picture, times).save(folder / f"{stem}.png")
        name = f"sprites, {times} times"
        out, fits = place.fit(name, [folder / f"{stem}.png" for stem in pictures], drawn=True)
        yield name, {stem: score(place, repeated(picture, SCORED_AT), out / stem, fits.get(stem, {})) for stem, picture in pictures.items()}


if __name__ == "__main__":
    target = pathlib.Path(sys.argv[1])
    for times in TIMES:
        (target / str(times)).mkdir(parents=True, exist_ok=True)
        for stem, picture in drawn(int(sys.argv[2]), int(sys.argv[3])).items():
            repeated(picture, times).save(target / str(times) / f"{stem}.png")
