"""The picture sets of the baseline: where their pictures come from, and how they are fitted and scored.

Each function yields (name of the set, {picture: scores}). What is not there is put on `place.skipped`, with the reason.
"""

import csv
import hashlib
import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys

import numpy as np
from PIL import Image

import charts
import measure
from spoiled import spoiled
from sprites import sprites

# Seed and number of the generated scenes. Nobody debugs on them: whoever wants pictures to look at takes another seed (--seed).
FRESH_SEED = 915_402_117
FRESH_COUNT = 256
# Each preset has a seed of its own, and noise the one after them.
PRESETS = ["mds-hr", "multi-dsprites"]
FINISHES = ["clean", "noise 0.02", "noise 0.05", "jpeg 80"]
REAL_SIZES = "128,256,512,400j"
# Pictures per set with --quick.
QUICK = 6


class Place:
    """Where things are, and what was left out."""

    def __init__(self, dvp, work, shared, is_quick, seed=FRESH_SEED, count=FRESH_COUNT, env=None):
        # The environment that `dvp fit` runs in; none is ours.
        self.env = env
        self.dvp, self.work, self.shared, self.is_quick, self.seed, self.count = dvp, work, shared, is_quick, seed, count
        self.skipped, self.hashes = [], {}

    def skip(self, what, why):
        self.skipped.append(f"{what}: {why}")
        print(f"SKIPPED {what}: {why}", file=sys.stderr, flush=True)

    def some(self, paths):
        """The pictures of a set that are fitted: all, or a few from everywhere in it."""
        paths = sorted(paths)
        return paths[:: -(-len(paths) // QUICK) or 1] if self.is_quick else paths

    def out(self, name):
        """Where the scenes of a set go."""
        return self.work / "out" / name.replace(" ", "_").replace(",", "")

    def fit(self, name, paths, options=(), drawn=False):
        """Fits pictures to a folder, one thread: the folder, and figures by picture. `drawn`: with their SVG.

        A hash of the pictures tells whether two records are about the same ones.
        """
        out = self.out(name)
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir(parents=True)
        digest = hashlib.sha256()
        for path in paths:
            digest.update(pathlib.Path(path).read_bytes())
        self.hashes[name] = digest.hexdigest()[:16]
        print(f"{name}: {len(paths)} files", file=sys.stderr, flush=True)
        command = [self.dvp, "fit", *map(str, paths), "--out", out, "--threads", "1", "--no-png", *([] if drawn else ["--no-svg"]), "--json",
                   "--table", out / "table.csv", *options]
        done = subprocess.run(command, capture_output=True, text=True, env=self.env)
        try:
            images = json.loads(done.stdout)["images"]
        except (json.JSONDecodeError, KeyError):
            print(f"{name}: dvp fit failed with code {done.returncode}: {done.stderr[-500:]}", file=sys.stderr)
            images = []
        return out, {i["stem"]: dict(fitted=i.get("objects"), mae=i.get("mae"), bits=i.get("bits"), ms=i.get("cpu_ms"),
                                     doubted=bool(i.get("doubts")))
                     for i in images}

    def evaluated(self, name, paths, data, options=(), against=()):
        """Fits pictures and scores them with `dvp evaluate` against the truth of `data`."""
        out, fits = self.fit(name, paths, options)
        table = out / "scores.csv"
        subprocess.run([self.dvp, "evaluate", out, data, "--threads", "1", "--csv", table, *against], capture_output=True)
        scores = {}
        wanted = None if against else {pathlib.Path(p).stem for p in paths}
        for row in csv.DictReader(open(table, encoding="utf8")) if table.exists() else []:
            stem = row["stem"]
            if wanted is not None and stem not in wanted:
                continue
            fit = fits.get(stem, {})
            score = scores[stem] = dict(right=False, **{k: fit[k] for k in ("bits", "ms", "doubted") if fit.get(k) is not None})
            if row["mae"]:
                score.update(mae=float(row["mae"]), ari=float(row["ari"]), objects=int(row["true_objects"]),
                             found=int(row["found_objects"]), right=row["true_objects"] == row["found_objects"])
        for stem in (wanted or set()) - set(scores):
            scores[stem] = dict(right=False)
        return scores


def val(place):
    """The reference's 256 validation images of MDS-HR, and the first 32 as float pixels, with and without its shapes."""
    folder = place.shared / "mdshr"
    if not folder.is_dir():
        return place.skip("val", f"{folder} is not there")
    for known, options in [("", ()), (", bank", ("--bank", "mdshr"))]:
        name, paths = f"mdshr val{known}", place.some((folder / "val").glob("*.png"))
        yield name, place.evaluated(name, paths, folder / "val", options)
        floats = folder / "val_first32_f32.npy"
        if not place.is_quick:
            yield f"mdshr val, float{known}", place.evaluated(f"mdshr val, float{known}", [floats], folder / "val", options,
                                                              ("--npy", floats))


def spoil(source, target, finish, seed):
    """Copies of pictures with Gaussian noise (standard deviation as a share of white) or as JPEG of quality 80, 4:2:0."""
    target.mkdir(parents=True)
    for number, path in enumerate(sorted(source.glob("*.png"))):
        pixels = measure.picture(path)
        if finish == "jpeg 80":
            Image.fromarray(pixels).save(target / f"{path.stem}.jpg", quality=80, subsampling=2)
        else:
            noise = np.random.default_rng([seed, number]).normal(0, 255 * float(finish.split()[1]), pixels.shape)
            Image.fromarray(np.clip(np.rint(pixels + noise), 0, 255).astype(np.uint8)).save(target / path.name)


def fresh(place):
    """Scenes of MDS-HR and of the like of Multi-dSprites, clean, noisy and as JPEG; errors against the clean picture."""
    # The scenes of every seed and number stay, so that records of one are about the same pictures.
    reported = (place.seed, place.count) == (FRESH_SEED, FRESH_COUNT)
    root = place.work / ("fresh" if reported else f"fresh-{place.seed}-{place.count}")
    for number, preset in enumerate(PRESETS):
        data = root / preset
        if not data.is_dir():
            subprocess.run([place.dvp, "generate", "--preset", preset, "--count", str(place.count), "--seed", str(place.seed + number),
                            "--out", data], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for finish in FINISHES:
            source = data if finish == "clean" else root / f"{preset}-{finish.replace(' ', '-')}"
            if not source.is_dir():
                spoil(data, source, finish, place.seed + len(PRESETS))
            paths = place.some([p for p in source.iterdir() if p.suffix in (".png", ".jpg")])
            for known, options in [("", ()), (", bank", ("--bank", "mdshr"))]:
                name = f"{preset} fresh, {finish}{known}"
                yield name, place.evaluated(name, paths, data, options)


def pictures(place):
    """Our own SVGs and families of random pictures, as the suite `tests/pictures` draws them."""
    root = place.work / "pictures"
    if not root.is_dir():
        command = f"cargo run --release -p dvp-tests --example any_picture -- --keep {root}"
        return place.skip("pictures", f"{root} is not there; make it: {command}")
    for folder in sorted(root.iterdir()):
        data = folder / "data"
        paths = [p for p in data.iterdir() if p.suffix in (".png", ".gif") and not p.name.endswith(".labels.png")]
        options = ("--bank", "mdshr") if folder.name.endswith("-bank") else ()
        yield f"pictures {folder.name}", place.evaluated(f"pictures {folder.name}", place.some(paths), data, options)


def real_script(place, what):
    """`real.py` as a module; none, said, where it or Node.js is missing."""
    path = place.shared / "real/real.py"
    missing = [str(path)] if not path.exists() else [p for p in ("node", "npm") if not shutil.which(p)]
    if missing:
        return place.skip(what, f"{', '.join(missing)} not there")
    spec = importlib.util.spec_from_file_location("real", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run_real(place, script, cache, sizes, peers=None, limit=()):
    """Runs `real.py` over a cache: scores of ours by "SET/SIZE/NAME"."""
    call = lambda *a: subprocess.run([sys.executable, script.__file__, *a], check=True, stdout=subprocess.DEVNULL)
    if peers and not place.is_quick:
        call("run", cache, "--sizes", peers, "--peers")
    call("run", cache, "--dvp", place.dvp, "--sizes", sizes, *limit)
    call("score", cache, "--sizes", sizes)
    return json.loads((cache / "scores-dvp.json").read_text())


def real(place):
    """Icons, flags and emoji from npm, drawn by resvg, scored at four times their size by `real.py`; peers at 256 px."""
    script = real_script(place, "real")
    if not script:
        return
    cache = place.work / "real"
    if not (cache / "src").exists():
        subprocess.run([sys.executable, script.__file__, "make", place.shared / "real/sets.json", cache], check=True)
    sizes = "256" if place.is_quick else REAL_SIZES
    scores = run_real(place, script, cache, sizes, "256", ["--limit", str(QUICK)] if place.is_quick else [])
    keys = ("bad", "dE", "dist", "missed", "numbers", "ms")
    for method in ("dvp", "vtracer", "potrace"):
        path = cache / f"scores-{method}.json"
        found = scores if method == "dvp" else json.loads(path.read_text()) if path.exists() else {}
        for group in sorted({tuple(key.split("/")[:2]) for key in found}, key=lambda g: (g[1], g[0])):
            of_group = {key.split("/")[2]: s for key, s in found.items() if tuple(key.split("/")[:2]) == group}
            rows = {name: {k: s[k] for k in keys if k in s} for name, s in of_group.items()}
            yield f"real {group[0]} {group[1]}" + (f" ({method})" if method != "dvp" else ""), rows


# Pictures of ../shared/holes, from the first on, that somebody has looked at.
HOLES_SEEN = 20


def holes(place):
    """Squares and triangles with openings, partly hidden. Beside ours the row of connected components of equal color. The first HOLES_SEEN
    pictures are left out: the fit was mended on them."""
    folder = place.shared / "holes"
    if not folder.is_dir():
        return place.skip("holes", f"{folder} is not there")
    paths = place.some(p for p in folder.glob("*.png") if "." not in p.stem and int(p.stem) >= HOLES_SEEN)
    out, fits = place.fit("holes", paths, ("--labels", "--whole"))
    ours, simple = {}, {}
    for path in paths:
        stem, pixels = path.stem, measure.picture(path)
        width = pixels.shape[1]
        truth = measure.label_map(folder / f"{stem}.labels.png"), measure.tiles(folder / f"{stem}.whole.png", width)
        labels, masks = measure.connected_components(pixels)
        simple[stem] = measure.openings(*truth, labels, masks.astype(np.float32), len(masks))
        fit = fits.get(stem, {})
        ours[stem] = dict(right=False)
        if fit.get("fitted") is not None and (out / f"{stem}.labels.png").exists():
            whole = out / f"{stem}.whole.png"
            found = measure.tiles(whole, width) if whole.exists() else np.zeros((0, *pixels.shape[:2]), np.float32)
            ours[stem] = measure.openings(*truth, measure.label_map(out / f"{stem}.labels.png"), found, fit["fitted"])
        ours[stem].update({k: fit[k] for k in ("mae", "bits", "ms", "doubted") if fit.get(k) is not None})
    yield "holes (connected components)", simple
    yield "holes", ours


def circles(place):
    """Circles and ellipses of exact coverage: errors in px and in stated standard deviations."""
    folder = place.shared / "circles"
    if not folder.is_dir():
        return place.skip("circles", f"{folder} is not there")
    truth = json.loads((folder / "truth.json").read_text())
    paths = place.some(folder.glob("*.png"))
    out, fits = place.fit("circles", paths)
    stems = {p.stem for p in paths}
    scores = measure.circles(out / "table.csv", {k: t for k, t in truth.items() if k in stems})
    for stem, score in scores.items():
        score.update({k: fits.get(stem, {})[k] for k in ("mae", "bits", "ms", "doubted") if fits.get(stem, {}).get(k) is not None})
    is_circle = lambda stem: truth[stem]["a"] == truth[stem]["b"]
    for name, of_kind in [("circles", is_circle), ("ellipses", lambda stem: not is_circle(stem))]:
        yield name, {stem: score for stem, score in scores.items() if of_kind(stem)}


def chart_sets(place):
    """Charts of matplotlib: count of marks and, at four times their size, what is destroyed."""
    script = real_script(place, "charts")
    if not script:
        return
    cache = place.work / "charts"
    truth = cache / "truth/charts"
    if not (cache / "src").exists():
        charts.make(cache)
        for name in ("venv", "node_modules", "package.json"):
            if (place.work / "real" / name).exists() and not (cache / name).exists():
                (cache / name).symlink_to((place.work / "real" / name).resolve())
        script.tools(str(cache))
        script.draw(str(cache), [dict(src=f"{truth}/{n}.svg", out=f"{cache}/src/charts/{z}/{n}.png", width=z)
                                 for n in charts.names() for z in (128, 256, 512, 1024, 2048)])
        (cache / "sets.json").write_text("{}")
        (cache / "src/agg").mkdir()
        (cache / "src/agg/256").symlink_to(cache / "agg256")
        (cache / "src/agg/1024").symlink_to(cache / "src/charts/1024")
        (cache / "truth/agg").symlink_to(truth)
    rendered = run_real(place, script, cache, "256" if place.is_quick else ",".join(map(str, charts.SIZES)))
    for group in sorted({tuple(key.split("/")[:2]) for key in rendered}):
        name = f"charts {group[1]}" + (", matplotlib's PNG" if group[0] == "agg" else "")
        paths = place.some((cache / "src" / group[0] / group[1]).glob("*.png"))
        out, fits = place.fit(name, paths, ("--labels", "--whole"))
        scores = {}
        for path in paths:
            stem, fit = path.stem, fits.get(path.stem, {})
            score = scores[stem] = dict(right=False)
            scene, whole = out / f"{stem}.json", out / f"{stem}.whole.png"
            if fit.get("fitted") is not None and scene.exists():
                objects = json.loads(scene.read_text())["objects"]
                side = measure.picture(path).shape[1]
                found = read_whole(whole, side, len(objects))
                score.update(charts.count(truth, stem, found, [o["color"] for o in objects]))
            score.update({k: fit[k] for k in ("mae", "bits", "ms", "doubted") if fit.get(k) is not None})
            drawn = rendered.get("/".join([*group, stem]), {})
            score.update({k: drawn[k] for k in ("bad", "dE", "dist", "missed") if k in drawn})
            score.update(charts.wrecks(drawn.get("bad", 100.0), drawn.get("missed", 100.0)))
        yield name, scores


def read_whole(path, side, count):
    """Coverage of all objects of a scene, empty ones kept: (objects, rows, columns)."""
    if count == 0 or not path.exists():
        return np.zeros((0, side, side), np.float32)
    wide = np.asarray(Image.open(path), np.float32) / 255
    return wide.reshape(wide.shape[0], count, side).transpose(1, 0, 2)


ALL = dict(val=val, fresh=fresh, pictures=pictures, holes=holes, circles=circles, charts=chart_sets, real=real, spoiled=spoiled,
           sprites=sprites)
