"""Things of one color that overlap or touch: how many are found, and how well, by `dvp fit`, by connected components and by a watershed.

    overlaps.py --dvp EXE [--work DIR] [--count 12] [--seed N] [--other EXE]

Prints the table of overlaps.md. `--other` is a second program, for comparison. Needs numpy, scipy, pillow, scikit-image and matplotlib. Nobody debugs on the
seed below: who looks at its pictures while changing the fit takes another one.
"""

import json
import subprocess

import matplotlib
import numpy as np
from PIL import Image
from scipy.ndimage import distance_transform_edt, gaussian_filter
from scipy.optimize import linear_sum_assignment
from skimage import feature, filters, measure, segmentation

import counted

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

SEED = 611_954_213
SIDE, FINER, THINGS = 192, 8, 12
LEAST_SEEN = 0.55  # Share of each thing that no other one covers.
LEAST_OF_COMPONENT = 12  # Pixels.

# Name, what is drawn, share of a diameter from one to the next, standard deviations of the blur (px) and of the noise, photons at 1.
KINDS = [
    ("disks of one radius", "disks", (0.45, 0.95), 0, 0, 0),
    ("disks of many radii", "bubbles", (0.45, 0.95), 0, 0, 0),
    ("ellipses that overlap", "ellipses", (0.6, 0.95), 0, 0, 0),
    ("ellipses, blurred", "ellipses", (0.7, 1.0), 0.8, 0, 0),
    ("ellipses, blurred, noise of .02", "ellipses", (0.7, 1.0), 0.8, 0.02, 0),
    ("ellipses, blurred, 400 photons", "ellipses", (0.7, 1.0), 0.8, 0.005, 400),
    *((f"markers of a chart: {name}", mark, (0.45, 0.95), 0, 0, 0) for name, mark in
      (("disks", "o"), ("squares", "s"), ("triangles", "^"), ("diamonds", "D"), ("pentagons", "p"))),
]


def mask(random, what, middle, size, finer):
    """Where a thing is, in `finer` places a pixel each way."""
    y, x = (np.mgrid[0 : SIDE * finer, 0 : SIDE * finer] + 0.5) / finer
    if what == "ellipses":
        turn, narrow = random.uniform(0, np.pi), random.uniform(0.6, 0.95)
    else:
        turn, narrow = 0, 1
    u = (x - middle[0]) * np.cos(turn) + (y - middle[1]) * np.sin(turn)
    v = (y - middle[1]) * np.cos(turn) - (x - middle[0]) * np.sin(turn)
    return np.hypot(u, v / narrow) < size


def marked(middles, mark, size, color):
    """A chart without axes: a marker of so many pixels at each place."""
    figure = plt.figure(figsize=(SIDE / 100, SIDE / 100), dpi=100)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.set(xlim=(0, SIDE), ylim=(SIDE, 0))
    axes.axis("off")
    points = np.array(middles)
    axes.scatter(points[:, 0], points[:, 1], s=(0.72 * size) ** 2, color=[color] * len(middles), marker=mark, linewidths=0)
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())[:, :, :3].copy()
    plt.close(figure)
    return pixels


def is_seen(masks):
    """Whether enough is seen of each thing."""
    count = np.sum(masks, axis=0)
    return all((one & (count == 1)).sum() >= LEAST_SEEN * one.sum() for one in masks)


def made(random, what, apart):
    """The picture from 0 to 1, and where each thing is."""
    is_mark = len(what) == 1
    one_size, color = random.uniform(7, 10), random.uniform(0, 0.6, 3)
    middles, sizes, masks, fine, tries = [], [], [], [], 0
    while len(masks) < THINGS and tries < 400:
        tries += 1
        size = one_size if is_mark or what == "disks" else one_size * random.uniform(0.7, 1.4)
        middle = random.uniform(size + 2, SIDE - size - 2, 2)
        if masks and random.random() < 0.6:
            k, turn = random.integers(len(masks)), random.uniform(0, 2 * np.pi)
            middle = middles[k] + (size + sizes[k]) * random.uniform(*apart) * np.array([np.cos(turn), np.sin(turn)])
        if min(middle) < size + 2 or max(middle) > SIDE - size - 2:
            continue
        if is_mark:
            shown = marked([middle], what, 2 * size, (0, 0, 0))[:, :, 0] < 128
        else:
            finely = mask(random, what, middle, size, FINER)
            shown = finely.reshape(SIDE, FINER, SIDE, FINER).mean((1, 3)) >= 0.5
        if not is_seen([*masks, shown]):
            continue
        middles.append(middle)
        sizes.append(size)
        masks.append(shown)
        fine.append(None if is_mark else finely)
    if is_mark:
        return marked(middles, what, 2 * one_size, color) / 255, np.array(masks)
    share = np.any(fine, axis=0).reshape(SIDE, FINER, SIDE, FINER).mean((1, 3))[:, :, None]
    return 0.95 * (1 - share) + color * share, np.array(masks)


def taken(random, picture, blur, noise, photons):
    """The picture as a camera takes it, in gray, if it has a blur."""
    if blur:
        gray = gaussian_filter(picture.mean(2), blur)
        gray = random.poisson(gray * photons) / photons if photons else gray
        picture = np.repeat((gray + random.normal(0, noise, gray.shape))[:, :, None], 3, 2)
    return np.round(255 * np.clip(picture, 0, 1)).astype(np.uint8)


def overlap(truth, found):
    """Mean intersection over union of the whole things with those found that fit them best, one each."""
    if not len(found):
        return 0.0
    a, b = (masks.reshape(len(masks), -1).astype(np.float32) for masks in (truth, found))
    both = a @ b.T
    share = both / np.maximum(a.sum(1)[:, None] + b.sum(1)[None] - both, 1)
    rows, columns = linear_sum_assignment(-share)
    return float(share[rows, columns].sum() / len(truth))


def fitted(dvp, files, out):
    """The whole things of each picture."""
    done = subprocess.run([dvp, "fit", *files, "--out", out, "--whole", "--no-png", "--no-svg", "--threads", "2"], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr[-500:])
    results = []
    for file in files:
        things = json.loads((out / f"{file.stem}.json").read_text())["objects"]
        whole = np.array(Image.open(out / f"{file.stem}.whole.png")) if things else np.zeros((SIDE, 0))
        results.append((whole >= 128).reshape(SIDE, -1, SIDE).transpose(1, 0, 2))
    return results


def dark(picture):
    """What is darker than Otsu's threshold."""
    gray = picture.mean(2)
    return gray < filters.threshold_otsu(gray)


def components(picture):
    """Connected components of what is dark."""
    labels = measure.label(dark(picture))
    return np.array([labels == k for k in range(1, labels.max() + 1) if (labels == k).sum() >= LEAST_OF_COMPONENT])


def watershed(picture):
    """What is dark, flooded from the places that are farthest from its edge."""
    inside = dark(picture)
    far = gaussian_filter(distance_transform_edt(inside), 1)
    peaks = feature.peak_local_max(far, min_distance=4, labels=measure.label(inside))
    seeds = np.zeros(inside.shape, int)
    seeds[tuple(peaks.T)] = np.arange(1, len(peaks) + 1)
    labels = segmentation.watershed(-far, seeds, mask=inside)
    return np.array([labels == k for k in range(1, len(peaks) + 1)])


def main():
    def drawn(random, what, apart, *camera):
        picture, masks = made(random, what, apart)
        return taken(random, picture, *camera), masks

    def score(truth, things):
        return len(things) == len(truth), overlap(truth, things)

    peers = {"components": components, "watershed": watershed}
    counted.table(counted.arguments(SEED), KINDS, drawn, peers, fitted, score)


if __name__ == "__main__":
    main()
