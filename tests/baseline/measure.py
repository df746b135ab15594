"""Measures that `dvp evaluate` does not give: objects with openings, circles and ellipses, connected components.

All read what `dvp fit --labels --whole --table` writes and know nothing of scenes, so every kind of shape is measured alike.
Pictures are arrays (rows, columns); label maps hold 0 for the background and k for object k.
"""

import csv
import math
import pathlib

import numpy as np
from PIL import Image
from scipy import ndimage
from scipy.optimize import linear_sum_assignment

# Side of the square that fits into every connected component, px: what is thinner is mixtures along edges.
LEAST_COMPONENT = 2


def rand_index(truth, found):
    """Adjusted Rand index of two label arrays of one length; 1 where both have one label."""
    if len(truth) == 0:
        return 1.0
    table = np.zeros((truth.max() + 1, found.max() + 1))
    np.add.at(table, (truth, found), 1)
    pairs = lambda n: (n * (n - 1) / 2).sum()
    both, rows, columns, total = pairs(table), pairs(table.sum(1)), pairs(table.sum(0)), pairs(np.array([len(truth)]))
    chance = rows * columns / max(total, 1)
    most = (rows + columns) / 2
    return 1.0 if most == chance else float((both - chance) / (most - chance))


def tiles(path, width):
    """Coverage of whole objects (objects, rows, columns), 0 to 1, from pictures side by side; those with nothing are left out."""
    wide = np.asarray(Image.open(path), np.float32) / 255
    parts = wide.reshape(wide.shape[0], wide.shape[1] // width, width).transpose(1, 0, 2)
    return parts[parts.max((1, 2), initial=0) >= 0.5]


def whole_iou(truth, found):
    """Mean over the true objects of the intersection over union of whole shapes; 0 for those that have no partner.

    Partners are those with the greatest sum.
    """
    if len(truth) == 0:
        return 1.0 if len(found) == 0 else 0.0
    iou = np.zeros((len(truth), len(found)))
    for i, a in enumerate(truth >= 0.5):
        for j, b in enumerate(found >= 0.5):
            iou[i, j] = (a & b).sum() / max(1, (a | b).sum())
    return float(iou[linear_sum_assignment(-iou)].sum() / len(truth))


def openings(truth_labels, truth_whole, labels, whole, objects):
    """Scores of one picture of objects with openings: `ari` of all pixels, `ari_objects` of those that truth gives to an object."""
    truth, found = truth_labels.ravel().astype(int), labels.ravel().astype(int)
    inside = truth > 0
    count = len(np.unique(truth[inside]))
    return dict(right=objects == count, objects=count, found=objects, ari=rand_index(truth, found),
                ari_objects=rand_index(truth[inside], found[inside]), whole_iou=whole_iou(truth_whole, whole))


def connected_components(picture):
    """Label map and masks of the parts of exactly one color: what the simplest program finds.

    Parts that hold no square of LEAST_COMPONENT pixels are edges: their pixels go to the nearest part. Parts of the commonest color
    are the background. Neighbors are the four beside a pixel.
    """
    flat = picture[..., 0].astype(int) << 16 | picture[..., 1].astype(int) << 8 | picture[..., 2]
    colors, sizes = np.unique(flat, return_counts=True)
    ground = colors[sizes.argmax()]
    square = np.ones((LEAST_COMPONENT, LEAST_COMPONENT), bool)
    labels, count = np.zeros(flat.shape, int), 0
    for color in colors[sizes >= LEAST_COMPONENT**2]:
        parts, _ = ndimage.label(flat == color)
        for part in np.unique(parts[ndimage.binary_opening(parts > 0, square)]):
            count += color != ground
            labels[parts == part] = count if color != ground else -1
    rows, columns = ndimage.distance_transform_edt(labels == 0, return_distances=False, return_indices=True)
    labels = np.maximum(labels[rows, columns], 0)
    return labels, np.array([labels == k for k in range(1, count + 1)]).reshape(count, *labels.shape)


def circles(table, truth):
    """Scores per picture of circles and ellipses from the table of `dvp fit`: errors in px and, where the table tells standard
    deviations, errors in units of them (z_x, z_y, z_radius; z_major, z_minor for ellipses).

    `radius`: of the circle of equal area. `axes`: the greater error of the half axes of the ellipse of equal second moments.
    """
    rows = {}
    with open(table, newline="", encoding="utf8") as file:
        for row in csv.DictReader(file):
            rows.setdefault(row["stem"], []).append(row)
    number = lambda row, key: float(row[key]) if row.get(key) else math.nan
    scores = {}
    for name, true in truth.items():
        found = [row for row in rows.get(name, []) if row["area_px2"]]
        score = scores[name] = dict(right=len(found) == 1, objects=1, found=len(found))
        if len(found) != 1:
            continue
        row = found[0]
        is_circle = true["a"] == true["b"]
        radius, area_sd = math.sqrt(number(row, "area_px2") / math.pi), number(row, "area_sd_px2")
        errors = {
            "x": (number(row, "centroid_x_px") - true["cx"], number(row, "centroid_x_sd_px")),
            "y": (number(row, "centroid_y_px") - true["cy"], number(row, "centroid_y_sd_px")),
            "radius": (radius - math.sqrt(true["a"] * true["b"]), area_sd / (2 * math.pi * radius)),
            "major": (number(row, "major_axis_px") / 2 - true["a"], number(row, "major_axis_sd_px") / 2),
            "minor": (number(row, "minor_axis_px") / 2 - true["b"], number(row, "minor_axis_sd_px") / 2),
        }
        score["center"] = math.hypot(errors["x"][0], errors["y"][0])
        score["radius"] = abs(errors["radius"][0])
        score["axes"] = max(abs(errors["major"][0]), abs(errors["minor"][0]))
        # Of a circle both axes tell the radius: the larger of two is biased, so its deviation is not asked.
        for key in ["x", "y", "radius"] if is_circle else ["x", "y", "radius", "major", "minor"]:
            error, deviation = errors[key]
            if deviation > 0:
                score["z_" + key] = error / deviation
    return scores


def picture(path):
    """Colors (rows, columns, 3) of 8 bits."""
    return np.asarray(Image.open(pathlib.Path(path)).convert("RGB"))


def label_map(path):
    return np.asarray(Image.open(path))
