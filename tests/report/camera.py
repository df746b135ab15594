"""Pictures as cameras take them: how many cells are found, and how well, by `dvp fit` and by Otsu's threshold with connected components.

    camera.py --dvp EXE [--work DIR] [--count 12] [--seed N] [--other EXE]

Prints the table of camera.md. Cells of one gray each on darker ground, no two touching, blurred; then what a camera does. `--other` is a second
program, for comparison. Needs numpy, scipy, pillow and scikit-image. Nobody debugs on the seed below: who looks at its pictures while changing the fit takes
another one.
"""

import json
import subprocess

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter
from skimage import filters, measure

import counted

SEED = 611_954_207
SIDE, CELLS, FINER = 192, 16, 4
LEAST_OF_THRESHOLD = 12  # Pixels of a component that is a cell.

# Name, light, standard deviation of even noise, photons at 1 (0: no noise of their number), blur (px), dead pixels, bits in a file of 16.
KINDS = [
    ("clean", "even", 0, 0, 1.0, 0, 0),
    ("even noise of .02", "even", 0.02, 0, 1.0, 0, 0),
    ("600 photons", "even", 0.005, 600, 1.0, 0, 0),
    ("200 photons", "even", 0.005, 200, 1.0, 0, 0),
    ("80 photons", "even", 0.005, 80, 1.0, 0, 0),
    ("light from a side, clean", "side", 0, 0, 1.0, 0, 0),
    ("light from a side, 400 photons", "side", 0.005, 400, 1.0, 0, 0),
    ("bright middle, clean", "middle", 0, 0, 1.0, 0, 0),
    ("bright middle, noise of .02", "middle", 0.02, 0, 1.0, 0, 0),
    ("dim corners (multiplied), clean", "multiplied", 0, 0, 1.0, 0, 0),
    ("dim corners (multiplied), 400 photons", "multiplied", 0.005, 400, 1.0, 0, 0),
    ("8 dead pixels, noise of .02", "even", 0.02, 0, 1.0, 8, 0),
    ("12 bits of 16, 400 photons", "even", 0.005, 400, 1.0, 0, 12),
    ("sharp, 400 photons", "even", 0.005, 400, 0.4, 0, 0),
]


def cells(random):
    """The picture in even light, and the number of the cell in each pixel, 0 the ground."""
    y, x = (np.mgrid[0 : SIDE * FINER, 0 : SIDE * FINER] + 0.5) / FINER
    shown, labels, placed = np.full(x.shape, 0.12), np.zeros((SIDE, SIDE), np.uint8), []
    while len(placed) < CELLS:
        radius = random.uniform(7, 15)
        middle = random.uniform(radius + 2, SIDE - radius - 2, 2)
        if any(np.hypot(*(middle - other)) < 1.25 * (radius + its) + 3 for other, its in placed):
            continue
        placed.append((middle, radius))
        turn, narrow = random.uniform(0, np.pi), random.uniform(0.65, 1)
        u = (x - middle[0]) * np.cos(turn) + (y - middle[1]) * np.sin(turn)
        v = (y - middle[1]) * np.cos(turn) - (x - middle[0]) * np.sin(turn)
        angle = np.arctan2(v / narrow, u)
        waves = sum(random.uniform(0, 0.06) * np.cos(k * angle + random.uniform(0, 2 * np.pi)) for k in (2, 3, 4))
        inside = np.hypot(u, v / narrow) < radius * (1 + waves)
        shown[inside] = random.uniform(0.4, 0.75)
        labels[inside.reshape(SIDE, FINER, SIDE, FINER).mean((1, 3)) > 0.5] = len(placed)
    return shown.reshape(SIDE, FINER, SIDE, FINER).mean((1, 3)), labels


def taken(random, even, light, noise, photons, blur, dead, bits):
    """The picture as a camera takes it, in 8 bits, or in so many of a file of 16."""
    y, x = (np.mgrid[0:SIDE, 0:SIDE] + 0.5) / SIDE - 0.5
    turn = random.uniform(0, 2 * np.pi)
    squares = (x - random.uniform(-0.1, 0.1)) ** 2 + (y - random.uniform(-0.1, 0.1)) ** 2
    if light == "side":
        even = even + 0.09 * (x * np.cos(turn) + y * np.sin(turn))
    elif light == "middle":
        even = even + 0.05 - 0.22 * squares
    elif light == "multiplied":
        even = even * (1 - 0.5 * squares)
    seen = np.clip(gaussian_filter(even, blur), 0, None)
    if photons:
        seen = random.poisson(seen * photons) / photons
    seen = np.clip(seen + random.normal(0, noise, seen.shape) if noise else seen, 0, 1)
    seen[random.integers(0, SIDE, dead), random.integers(0, SIDE, dead)] = 1
    if bits:
        return np.round(seen * (2**bits - 1)).astype(np.uint16)
    return np.round(seen * 255).astype(np.uint8)


def overlap(labels, found):
    """Mean intersection over union of each cell with the one found thing that shares most with it."""
    best = []
    for k in range(1, CELLS + 1):
        cell = labels == k
        others = [other for other in np.unique(found[cell]) if other]
        best.append(max((np.sum(cell & (found == other)) / np.sum(cell | (found == other)) for other in others), default=0))
    return float(np.mean(best))


def is_ground(thing):
    """Whether a thing is the ground in uneven light: a rectangle as large as the picture."""
    return thing["kind"] == "rectangle" and min(thing["size"]) >= 1


def fitted(dvp, files, out):
    """How many things but the ground are in each picture, and their labels."""
    done = subprocess.run([dvp, "fit", *files, "--out", out, "--labels", "--no-png", "--no-svg", "--threads", "2"], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr[-500:])
    results = []
    for file in files:
        things = json.loads((out / f"{file.stem}.json").read_text())["objects"]
        found = np.array(Image.open(out / f"{file.stem}.labels.png"))
        ground = [k for k, thing in enumerate(things, 1) if is_ground(thing)]
        results.append((len(things) - len(ground), np.where(np.isin(found, ground), 0, found)))
    return results


def thresholded(picture):
    """How many components lie above Otsu's threshold of the smoothed picture, and their labels."""
    smooth = filters.gaussian(picture.astype(float) / picture.max(), 1)
    found = measure.label(smooth > filters.threshold_otsu(smooth))
    for region in measure.regionprops(found):
        if region.area < LEAST_OF_THRESHOLD:
            found[found == region.label] = 0
    return len(np.unique(found)) - 1, found


def main():
    def drawn(random, *how):
        even, labels = cells(random)
        return taken(random, even, *how), labels

    def score(labels, result):
        count, found = result
        return count == CELLS, overlap(labels, found)

    counted.table(counted.arguments(SEED), KINDS, drawn, {"threshold": thresholded}, fitted, score)


if __name__ == "__main__":
    main()
