"""What dvp exports, opened by the programs that it is for.

Draws pictures and label maps, runs `dvp fit` on them with all exports, and holds the files against each other through
scikit-image, roifile, pycocotools, shapely, pyarrow, pandas and pyefd:

- label map: areas and centroids of skimage.measure.regionprops = the table (centroids of scikit-image are 0.5 px less)
- whole objects: the sum of each tile = the area of the table
- ImageJ ROIs: read by roifile, areas = the table, composites for holes
- COCO: read by pycocotools, masks = the label map
- GeoJSON: read by shapely, valid, areas = the table
- Parquet, read by pyarrow = CSV, read by pandas
- descriptors = those of pyefd of the ROI, for .csv and for .nef as Momocs reads it

    python tests/interop/check_exports.py [--dvp target/release/dvp]

The program must be built with `--features parquet`. All packages are needed: where one is missing nothing is checked, which is
said, and the exit code is 2; 1 means that a check failed.
"""

import argparse
import collections
import importlib
import importlib.metadata
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

PACKAGES = {}
MISSING = []
for name in ["skimage", "tifffile", "roifile", "pycocotools", "shapely", "pyarrow", "pandas", "pyefd"]:
    try:
        PACKAGES[name] = importlib.import_module(name)
    except ImportError:
        MISSING.append(name)

FAILED = []
WORST = collections.defaultdict(float)


def check(what, is_true, said=""):
    if not is_true:
        FAILED.append(f"{what}: {said}")


def close(what, found, known, tolerance):
    """Notes the greatest difference in units of the tolerance."""
    off = abs(found - known)
    WORST[what] = max(WORST[what], off)
    check(what, off <= tolerance, f"{found} instead of {known}, at most {tolerance} off")


def cover(inside, width, height, scale=8):
    """The covered share of each pixel, counted at scale x scale points."""
    x = (np.arange(width * scale) + 0.5) / scale
    y = ((np.arange(height * scale) + 0.5) / scale)[:, None]
    fine = np.broadcast_to(inside(x, y), (height * scale, width * scale))
    return fine.reshape(height, scale, width, scale).mean((1, 3))


def disk(cx, cy, r):
    return lambda x, y: np.hypot(x - cx, y - cy) < r


def ellipse(cx, cy, a, b, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return lambda x, y: ((c * (x - cx) + s * (y - cy)) / a) ** 2 + ((-s * (x - cx) + c * (y - cy)) / b) ** 2 < 1


def box(left, top, right, bottom):
    return lambda x, y: (left < x) & (x < right) & (top < y) & (y < bottom)


def picture(path, width, height, shapes, background=(240, 240, 235)):
    """Shapes in the order of painting, each with its color."""
    image = np.ones((height, width, 3)) * background
    for inside, color in shapes:
        share = cover(inside, width, height)[..., None]
        image = image * (1 - share) + np.array(color) * share
    PACKAGES["skimage"].io.imsave(path, np.round(image).astype(np.uint8), check_contrast=False)


def label_map(path, width, height, shapes):
    labels = np.zeros((height, width), np.int32)
    for inside, label in shapes:
        labels[cover(inside, width, height) >= 0.5] = label
    PACKAGES["tifffile"].imwrite(path, labels)


def polygon_area(points):
    x, y = np.asarray(points, float).T
    return 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)


def fit(dvp, arguments, out, code):
    names = ["--table", out / "table.csv", "--efd", out / "efd.csv", "--coco", out / "coco.json"]
    run = subprocess.run([dvp, "fit", *arguments, "--out", out, *names, "--labels", "--whole", "--roi", "--geojson",
                          "--scale", "0.5mm/px", "--harmonics", "12", "--no-svg", "--no-png"], capture_output=True, text=True)
    check("exit code", run.returncode == code, f"{run.returncode}: {run.stderr}")
    again = ["--table", out / "table.parquet", "--efd", out / "efd.nef"]
    run = subprocess.run([dvp, "fit", *arguments, "--out", out / "again", *again, "--scale", "0.5mm/px", "--harmonics", "12",
                          "--no-svg", "--no-png"], capture_output=True, text=True)
    check("exit code", run.returncode == code, f"{run.returncode}: {run.stderr}")


def read_table(out):
    # Failures have no number: whole numbers that may be missing.
    return PACKAGES["pandas"].read_csv(out / "table.csv", dtype={"object": "Int64"})


def check_parquet(out):
    table, arrow = read_table(out), PACKAGES["pyarrow"].parquet.read_table(out / "table.parquet")
    check("parquet: columns", list(table.columns) == arrow.column_names)
    check("parquet: kinds", arrow.schema.field("object").type == "int64" and arrow.schema.field("area_px2").type == "double"
          and arrow.schema.field("kind").type == "string", arrow.schema)
    for name in table.columns:
        ours, theirs = table[name], arrow.column(name).to_pandas()
        same = (ours.isna() & theirs.isna()) | (ours == theirs)
        check("parquet = csv", same.all(), name)


def check_scale(table):
    for name in table.columns:
        if name.endswith("_mm"):
            px = table[name[:-2] + "px"]
            check("mm", np.allclose(table[name], 0.5 * px, rtol=1e-7, atol=1e-8, equal_nan=True), name)
        elif name.endswith("_mm2"):
            px = table[name[:-3] + "px2"]
            check("mm2", np.allclose(table[name], 0.25 * px, rtol=1e-7, atol=1e-8, equal_nan=True), name)


def check_labels(out, rows):
    """What is seen of each object; only whole ones have the area and the centroid of the table."""
    stem = rows.stem.iloc[0]
    labels = PACKAGES["skimage"].io.imread(out / f"{stem}.labels.png")
    check("label map: bits", labels.dtype == (np.uint8 if rows.object.max() < 256 else np.uint16), labels.dtype)
    props = {prop.label: prop for prop in PACKAGES["skimage"].measure.regionprops(labels)}
    for row in rows.itertuples():
        prop = props.get(row.object)
        if row.visible < 0.5:
            continue
        check("label map: object", prop is not None, f"{stem} {row.object}")
        # Pixels are counted whole: an outline of length P meets about P of them, each off by up to half.
        # An outline from a mask rounds the corners where the border of the picture cuts the object.
        noise = 0.35 * np.sqrt(row.perimeter_px) + 0.5 + (0.01 * row.area_px2 if row.visible < 0.999 else 0)
        close("label map: area px2", prop.area, row.area_px2 * row.visible, noise + 0.003 * row.area_px2)
        if row.visible < 0.999 or row.area_px2 < 20:
            continue
        y, x = prop.centroid
        # Pixels along a straight edge are off together, by up to half.
        close("label map: centroid px", np.hypot(x + 0.5 - row.centroid_x_px, y + 0.5 - row.centroid_y_px), 0, 0.25)
        close("label map: axes %", 100 * prop.axis_major_length / row.major_axis_px, 100, 2)
        if row.angle_deg == row.angle_deg and row.major_axis_px > 1.3 * row.minor_axis_px:
            turn = (90 - np.degrees(prop.orientation) - row.angle_deg + 90) % 180 - 90
            close("label map: angle deg", turn, 0, 1.5)
    return labels


def check_whole(out, rows, width, height):
    image = PACKAGES["skimage"].io.imread(out / f"{rows.stem.iloc[0]}.whole.png")
    check("whole: size", image.shape == (height, width * len(rows)) and image.dtype == np.uint8, image.shape)
    for k, row in enumerate(rows.itertuples()):
        inside = (row.bounds_x_px >= 0 and row.bounds_y_px >= 0 and row.bounds_x_px + row.bounds_width_px <= width
                  and row.bounds_y_px + row.bounds_height_px <= height)
        if inside:
            total = image[:, k * width:(k + 1) * width].sum() / 255
            close("whole: area px2", total, row.area_px2, 0.05 * row.perimeter_px + 0.002 * row.area_px2)


def check_rois(out, rows):
    rois = PACKAGES["roifile"].roiread(out / f"{rows.stem.iloc[0]}.rois.zip")
    rois = rois if isinstance(rois, list) else [rois]
    check("roi: count", len(rois) == len(rows), len(rois))
    for roi, row in zip(rois, rows.itertuples()):
        check("roi: name", roi.name == f"{row.object:04}-{row.kind}", roi.name)
        if roi.composite:
            area = sum(polygon_area(path) for path in roi.coordinates(multi=True))
        else:
            area = polygon_area(roi.coordinates())
            left, top = roi.coordinates().min(0)
            close("roi: bounds px", max(abs(left - row.bounds_x_px), abs(top - row.bounds_y_px)), 0, 1e-4)
        close("roi: area px2", abs(area), row.area_px2, 1e-4 * row.area_px2 + 1e-3)


def check_geojson(out, rows):
    features = json.load(open(out / f"{rows.stem.iloc[0]}.geojson"))["features"]
    check("geojson: count", len(features) == len(rows))
    for feature, row in zip(features, rows.itertuples()):
        geometry = PACKAGES["shapely"].geometry.shape(feature["geometry"])
        check("geojson: valid", geometry.is_valid, PACKAGES["shapely"].validation.explain_validity(geometry))
        close("geojson: area px2", geometry.area, row.area_px2, 1e-4 * row.perimeter_px + 1e-3)
        close("geojson: centroid px", geometry.centroid.x, row.centroid_x_px, 1e-3)
        check("geojson: properties", feature["properties"]["area_px2"] == row.area_px2, feature["properties"])


def check_coco(out, table, labels):
    from pycocotools.coco import COCO
    data = COCO(out / "coco.json")
    known = {row.picture for row in table[table.error.isna()].itertuples()}
    images = {image["file_name"]: image for image in data.imgs.values()}
    check("coco: pictures", known <= set(images), images)
    check("coco: count", len(data.anns) == table.error.isna().sum())
    for path, rows in table[table.error.isna()].groupby("picture"):
        annotations = data.imgToAnns[images[path]["id"]]
        for annotation, row in zip(annotations, rows.itertuples()):
            check("coco: category", data.cats[annotation["category_id"]]["name"] == row.kind)
            close("coco: area px2", annotation["area"], row.area_px2, 1e-3)
            if row.visible > 0.999:
                mask, seen = data.annToMask(annotation) > 0, labels[row.stem] == row.object
                iou = (mask & seen).sum() / (mask | seen).sum()
                # pycocotools rounds polygons to half pixels: off by up to a pixel along the outline.
                least = 1 - 0.5 * row.perimeter_px / row.area_px2
                WORST["coco: 1 - IoU"] = max(WORST["coco: 1 - IoU"], 1 - iou)
                check("coco: mask", iou >= least, f"{path} {row.object}: {iou}, at least {least}")


def read_nef(path):
    """As nef2Coe of Momocs does: the number of harmonics from the eighth character on, then blocks of a name and its rows."""
    lines = open(path).read().splitlines()
    at = next(i for i, line in enumerate(lines) if "HARMO" in line)
    count = int(lines[at][7:])
    body = lines[at + 1:]
    check("nef: blocks", len(body) % (count + 1) == 0)
    return {body[i]: np.array([[float(x) for x in line.split(" ") if x] for line in body[i + 1:i + 1 + count]])
            for i in range(0, len(body), count + 1)}


def check_efd(out, table):
    rows = PACKAGES["pandas"].read_csv(out / "efd.csv")
    nef = read_nef(out / "efd.nef")
    for row in table[table.error.isna()].itertuples():
        ours = rows[(rows.picture == row.picture) & (rows.object == row.object)][["a", "b", "c", "d"]].to_numpy()
        theirs = nef[f"{row.stem}_{row.object}"]
        check("nef = csv", ours.shape == (12, 4) and np.abs(ours - theirs).max() < 2e-9, row)
        feature = next(f for f in json.load(open(out / f"{row.stem}.geojson"))["features"] if f["id"] == row.object)
        geometry = feature["geometry"]
        outer = [geometry["coordinates"][0]] if geometry["type"] == "Polygon" else [p[0] for p in geometry["coordinates"]]
        ring = np.array(max(outer, key=lambda ring: abs(polygon_area(ring))))
        known = PACKAGES["pyefd"].elliptic_fourier_descriptors(ring, order=12, normalize=True)
        # The other end of the long axis: even harmonics with the other sign. pyefd leaves the sign of the whole open.
        twins = [sign * known * other for sign in [1, -1] for other in [1, np.where(np.arange(12) % 2 == 0, 1, -1)[:, None]]]
        # Axes of equal length have no direction: such shapes are compared by their amplitudes.
        if ours[0, 3] > 0.98:
            close("efd: amplitudes", np.abs(np.linalg.norm(ours, axis=1) - np.linalg.norm(known, axis=1)).max(), 0, 5e-3)
        else:
            close("efd = pyefd", min(np.abs(ours - twin).max() for twin in twins), 0, 2e-3)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--dvp", default="target/release/dvp")
    arguments = parser.parse_args()
    if MISSING:
        print(f"NOT CHECKED: these packages are missing: {', '.join(MISSING)}", file=sys.stderr)
        return 2
    for module in ["skimage.io", "skimage.measure", "pyarrow.parquet", "shapely.geometry", "shapely.validation"]:
        importlib.import_module(module)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "pictures").mkdir()
        picture(folder / "pictures" / "apart.png", 160, 120, [
            (disk(30.3, 32.7, 20.2), (200, 40, 30)), (ellipse(95.2, 40.1, 34.5, 12.3, 25), (30, 60, 170)),
            (ellipse(40.7, 88.3, 9.1, 22.4, 10), (20, 140, 60)), (disk(120.4, 90.6, 15.5), (90, 20, 120))])
        picture(folder / "pictures" / "hidden.png", 128, 96, [
            (disk(50.2, 48.1, 30.3), (210, 160, 20)), (box(60.5, 20.2, 110.3, 76.8), (20, 90, 150))])
        picture(folder / "pictures" / "cropped.png", 96, 96, [
            (disk(4.2, 50.3, 25.1), (160, 30, 60)), (disk(70.4, 30.9, 12.2), (30, 120, 40))])
        (folder / "pictures" / "broken.png").write_bytes(b"no picture")
        label_map(folder / "masks.tif", 160, 160, [
            (lambda x, y: disk(40.2, 40.4, 25.3)(x, y) & ~disk(44.1, 38.7, 11.2)(x, y), 5), (box(80, 20, 130, 44), 9),
            (disk(0.4, 110.2, 22.3), 12), (lambda x, y: disk(70.1, 110.3, 14.2)(x, y) | disk(100.4, 120.7, 10.1)(x, y), 300),
            (lambda x, y: np.hypot(x - 130, y - 120) < 14 + 4 * np.cos(5 * np.arctan2(y - 120, x - 130)), 7000)])
        counts = []
        for arguments_of, out, code in [([folder / "pictures"], folder / "out", 1), (["--masks", folder / "masks.tif"], folder / "out2", 0)]:
            fit(arguments.dvp, arguments_of, out, code)
            table = read_table(out)
            failed = table[table.error.notna()]
            check("failures have a row", len(failed) == code, failed)
            check("failures have nothing else", failed.drop(columns=["picture", "stem", "error"]).isna().all().all(), failed)
            check_parquet(out)
            found = table[table.error.isna()]
            check_scale(found)
            labels = {}
            for stem, rows in found.groupby("stem"):
                labels[stem] = check_labels(out, rows)
                height, width = labels[stem].shape
                check_whole(out, rows, width, height)
                check_rois(out, rows)
                check_geojson(out, rows)
            check_coco(out, table, labels)
            check_efd(out, table)
            counts.append(len(found))
        check("objects of pictures", counts[0] == 8, counts)
        check("objects of masks", counts[1] == 5, counts)
    versions = {name: getattr(module, "__version__", None) or importlib.metadata.version(name) for name, module in PACKAGES.items()}
    print(", ".join(f"{name} {version}" for name, version in versions.items()))
    print(f"{counts[0]} objects of pictures, {counts[1]} objects of masks; greatest differences:")
    for what, off in WORST.items():
        print(f"  {what}: {off:.3g}")
    for failure in FAILED[:40]:
        print(f"FAILED {failure}", file=sys.stderr)
    print(f"{len(FAILED)} checks failed")
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
