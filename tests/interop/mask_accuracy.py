"""How close outlines from masks come to what was drawn, beside the contours of scikit-image.

Draws disks, ellipses and random blobs at 16 times the size, takes what is covered by at least half for their masks, and compares the areas and outlines of `dvp fit --masks` and of
skimage.measure.find_contours at level 0.5 with the shape that was drawn.

    python tests/interop/mask_accuracy.py [--dvp target/release/dvp] [--count 40] [--seed 1]

Needs numpy, scipy, scikit-image, tifffile. Exits with 1 if dvp is not the closer one on every kind.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import skimage
import tifffile
from scipy.spatial import cKDTree

SIDE = 128


def closed(points):
    return np.vstack([points, points[:1]])


def dense(points, step=0.05):
    """Points at most `step` apart along a closed polygon."""
    p = closed(points)
    parts = [p[i] + (p[i + 1] - p[i]) * np.linspace(0, 1, max(int(np.hypot(*(p[i + 1] - p[i])) / step), 1), endpoint=False)[:, None]
             for i in range(len(p) - 1)]
    return np.vstack(parts)


def area(points):
    p = closed(points)
    return 0.5 * abs(np.sum(p[:-1, 0] * p[1:, 1] - p[1:, 0] * p[:-1, 1]))


def outline(kind, rng):
    """A closed curve in pixels: its points, its center, and its distance from there by the angle."""
    t = np.linspace(0, 2 * np.pi, 2048, endpoint=False)
    center = SIDE / 2 + rng.uniform(-2, 2, 2)
    size = rng.uniform(5, 40)
    if kind == "disk":
        radius = np.full_like(t, size)
    elif kind == "ellipse":
        ratio = rng.uniform(0.4, 0.9)
        turn = rng.uniform(0, np.pi)
        radius = size / np.hypot(np.cos(t - turn), np.sin(t - turn) / ratio)
    else:
        size = rng.uniform(12, 36)
        radius = np.full_like(t, size)
        for n in range(2, 7):
            radius += size * 0.35 / n ** 1.5 * rng.normal() * np.cos(n * t + rng.uniform(0, 2 * np.pi))
        radius = np.clip(radius, 4, 60)
    return center + radius[:, None] * np.c_[np.cos(t), np.sin(t)], center, (t, radius)


def mask_of(center, polar):
    """The pixels whose area is covered by at least half, counted at 16 x 16 points of each."""
    scale = 16
    at = (np.arange(SIDE * scale) + 0.5) / scale
    x, y = at - center[0], at[:, None] - center[1]
    fine = np.hypot(x, y) < np.interp(np.arctan2(y, x), *polar, period=2 * np.pi)
    return fine.reshape(SIDE, scale, SIDE, scale).mean((1, 3)) >= 0.5


def distances(points, truth):
    """Root mean square and greatest distance of an outline from the true one, both ways."""
    a, b = dense(points), dense(truth)
    d = np.concatenate([cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]])
    return np.sqrt(np.mean(d ** 2)), d.max()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--dvp", default="target/release/dvp")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    print(f"scikit-image {skimage.__version__}, {arguments.count} shapes of each kind in {SIDE} x {SIDE} pixels, seed {arguments.seed}")
    print("kind     | of      | area: mean error px2, mean |error| % | outline: rms px, greatest px")
    worse = 0
    for kind in ["disk", "ellipse", "blob"]:
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            truths = {}
            for i in range(arguments.count):
                truth, center, polar = outline(kind, rng)
                truths[f"{i:03}"] = (truth, mask_of(center, polar))
                tifffile.imwrite(folder / f"{i:03}.tif", truths[f"{i:03}"][1].astype(np.uint16) * 7)
            subprocess.run([arguments.dvp, "fit", "--masks", str(folder / "*.tif"), "--out", str(folder / "out"), "--geojson",
                            "--table", str(folder / "t.csv"), "--no-svg", "--no-png"], check=True, stdout=subprocess.DEVNULL)
            rows = {row["stem"]: row for row in csv.DictReader(open(folder / "t.csv"))}
            errors = {"dvp": [], "skimage": []}
            for stem, (truth, mask) in truths.items():
                assert rows[stem]["object"] == "7", "objects keep their labels"
                feature = json.load(open(folder / "out" / f"{stem}.geojson"))["features"][0]
                assert feature["geometry"]["type"] == "Polygon", stem
                ours = np.array(feature["geometry"]["coordinates"][0][:-1])
                # find_contours counts rows and columns from the center of the first pixel.
                theirs = max(skimage.measure.find_contours(np.pad(mask, 1).astype(float), 0.5), key=len)[:-1, ::-1] - 0.5
                for name, points in [("dvp", ours), ("skimage", theirs)]:
                    error = area(points) - area(truth)
                    errors[name].append([error, 100 * abs(error) / area(truth), *distances(points, truth)])
            means = {name: np.mean(values, 0) for name, values in errors.items()}
            for name, (bias, percent, rms, greatest) in means.items():
                print(f"{kind:8} | {name:7} | {bias:+7.2f}, {percent:5.2f} | {rms:.3f}, {greatest:.3f}")
            worse += means["dvp"][1] > means["skimage"][1] or means["dvp"][2] > means["skimage"][2]
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
