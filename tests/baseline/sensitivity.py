#!/usr/bin/env python3
"""What every chosen number of the fit decides: each is halved and doubled, and the pictures are fitted again.

    sensitivity.py WORK [--crate fit|trace] [--only NAME,NAME] [--every N] [--jobs 2] [--table OUT.csv]
    sensitivity.py show OUT.csv        # as markdown, the halved number before the doubled one; the report tests/report/sensitivity.md has it

The numbers are the constants of `models/fit/src/tuning.rs` and `models/trace/src/tuning.rs`. A copy of the workspace is made in WORK in which
they are read from the environment when the program runs; it is built once. Numbers that size arrays are left as they are, which is said.

Pictures, in groups. *drawings* (numbers of `trace`): what of the suite tests/pictures has hard edges and no noise, clean and as JPEG. *soft*
(numbers of `fit`): scenes that `dvp generate` draws from a seed of its own (nobody reports it), clean, noisy and as JPEG, with the shapes known and
without, and what of the suite is soft, noisy or coded. *spoiled* (numbers of `fit`): our own drawings of
the suite with noise of 0.02 and as JPEG. The suite is drawn by `cargo run --release -p dvp-tests --example any_picture -- --keep WORK/pictures`; without it
there are only the generated scenes, which is said.

A row: what the number is, by what it was multiplied, of how many pictures another scene was found, how many more have the right number of objects,
by how much the adjusted Rand index rose in the mean, and by what the error and the length of the description grew (geometric mean). **Numbers without an
effect here are not numbers without an effect**: halved and doubled thresholds may both lie where no picture of these is.
"""

import argparse
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

from packages import run_with_packages

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONSTANT = re.compile(r"^pub(\(crate\))? const ([A-Z0-9_]+): (\w+) =\s*([^;]+);", re.M)
FACTORS = (0.5, 2.0)
SEED = 77_001
COUNT = 12
# Whose numbers are tried on which pictures.
GROUPS = [("trace", "drawings"), ("fit", "soft"), ("fit", "spoiled")]
# Errors below a tenth of a step of 8 bits are rounding.
LEAST_MAE = 4e-5
READ = """
/// A number times what the environment says.
fn tuned(name: &str, value: f64) -> f64 {
    extern crate std;
    let Ok(text) = std::env::var("DVP_TUNE") else { return value };
    match text.split_once('=') {
        Some((of, factor)) if of == name => value * factor.parse::<f64>().expect("a factor"),
        _ => value,
    }
}
"""


def reader(name, kind, value):
    """A function in place of a constant."""
    whole = kind not in ("f64", "f32")
    # A whole number becomes another one in any case.
    number = f"{{ let of = {name} as f64; let new = tuned(\"{name}\", of); if new > of {{ new.ceil().max(of + 1.0) }} else if new < of " \
             f"{{ new.floor() }} else {{ of }} }}" if whole else f"tuned(\"{name}\", {name} as f64)"
    return (f"\npub fn {name.lower()}() -> {kind} {{\n    extern crate std;\n    static V: std::sync::OnceLock<{kind}> = std::sync::OnceLock::new();\n"
            f"    *V.get_or_init(|| ({number}) as {kind})\n}}\n")


def instrument(source, crate):
    """Makes functions of a crate's numbers and calls of their uses: the names, and those that stay."""
    folder = source / "models" / crate / "src"
    tuning = folder / "tuning.rs"
    text = tuning.read_text()
    found = {name: (kind, value) for _, name, kind, value in CONSTANT.findall(text)}
    readers = "".join(reader(name, kind, value) for name, (kind, value) in found.items())
    tuning.write_text(text + READ + readers)
    used = set()
    name = re.compile(r"(\btuning::)?(?<![\w:])(" + "|".join(found) + r")\b(?!\()|\btuning::(" + "|".join(found) + r")\b")
    for path in [p for c in ("fit", "trace") for p in (source / "models" / c / "src").rglob("*.rs")]:
        if path.name == "tuning.rs":
            continue
        lines = path.read_text()
        own = f"models/{crate}/src" in str(path)
        local = {n for n in found if re.search(rf"const {n}\b", lines)}
        out, in_use = [], False
        for line in lines.split("\n"):
            bare = line.split("//")[0]
            in_use = in_use or bool(re.match(r"\s*(pub(\(\w+\))? )?use ", bare))
            stays = in_use or re.match(r"\s*(pub(\([\w:]+\))? )?(const|static) ", bare) or re.search(r"; *(tuning::)?[A-Z_]{4,}\]", bare)
            if not stays:
                def call(match):
                    of = match.group(2) or match.group(3)
                    qualified = match.group(0).startswith("tuning::")
                    if of in local or not (own or qualified):
                        return match.group(0)
                    used.add(of)
                    return f"tuning::{of.lower()}()" if qualified else f"crate::tuning::{of.lower()}()"
                line = name.sub(call, bare) + line[len(bare):]
            if in_use and ";" in bare:
                in_use = False
            out.append(line)
        path.write_text("\n".join(out))
    return {n: found[n][1].strip() for n in found if n in used}, sorted(set(found) - used)


def build(work):
    """The program with numbers that the environment changes, and the numbers by crate."""
    source = work / "source"
    shutil.rmtree(source, ignore_errors=True)
    for path in subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True,
                               text=True).stdout.splitlines():
        if (ROOT / path).is_file():
            (source / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / path, source / path)
    numbers = {}
    for crate in ("trace", "fit"):
        numbers[crate], stay = instrument(source, crate)
        if stay:
            print(f"not varied in {crate}: {', '.join(stay)}", file=sys.stderr)
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", work / "target"))
    subprocess.run(["cargo", "build", "--release", "-p", "dvp"], cwd=source, check=True,
                   env={**os.environ, "CARGO_TARGET_DIR": str(target), "RUSTFLAGS": "--cap-lints allow -A warnings"})
    shutil.copy2(target / "release/dvp", work / "dvp")
    return numbers


def draw(work, every):
    """The pictures: (group, name, files, truth, options)."""
    import sets
    place = sets.Place(str(work / "dvp"), work, pathlib.Path("/nowhere"), False, SEED, COUNT)
    found = []

    def evaluated(name, paths, data, options=()):
        everything = sorted(paths)
        paths = everything[::every]
        is_drawing = not options and not any(word in name.lower() for word in ("mds-hr", "noise"))
        if is_drawing:
            found.append(("drawings", name, paths, data, options))
        if not is_drawing or any(word in name.lower() for word in ("jpeg", "blur", "scaled")):
            found.append(("soft", name, paths, data, options))
        elif name.startswith("pictures"):
            for finish in ("noise 0.02", "jpeg 80"):
                found.append(("spoiled", f"{name}, {finish}", spoiled(sets, work, everything, name, finish)[::every], data, options))
        return {}

    place.evaluated = evaluated
    for make in (sets.fresh, sets.pictures):
        list(make(place))
    return found


def spoiled(sets, work, paths, name, finish):
    """Copies of pictures with noise or as JPEG, made once."""
    target = work / "spoiled" / f"{name} {finish}".replace(" ", "_")
    if not target.is_dir():
        with tempfile.TemporaryDirectory(dir=work) as folder:
            for path in paths:
                shutil.copy(path, folder)
            sets.spoil(pathlib.Path(folder), target, finish, SEED)
    return sorted(target.iterdir())


def fit(work, pictures, number=None, factor=1.0):
    """Scores of every picture: (set, stem) -> scene, right, ari, mae, bits."""
    import sets
    env = dict(os.environ, **({"DVP_TUNE": f"{number}={factor}"} if number else {}))
    scores = {}
    with tempfile.TemporaryDirectory(dir=work) as folder:
        place = sets.Place(str(work / "dvp"), pathlib.Path(folder), pathlib.Path("/nowhere"), False, env=env)
        for _, name, paths, data, options in pictures:
            for stem, score in place.evaluated(name, paths, data, options).items():
                scene = place.out(name) / f"{stem}.json"
                scores[name, stem] = dict(
                    scene=scene.read_text() if scene.exists() else "", right=score["right"],
                    **{key: score.get(key, missing) for key, missing in (("ari", 0.0), ("mae", 1.0), ("bits", 0.0))})
    return scores


def against(before, after):
    """What changed, in numbers."""
    ratio = lambda of, least: math.exp(statistics.fmean(
        math.log(max(after[k][of], least) / max(before[k][of], least)) for k in before))
    return dict(pictures=len(before), changed=sum(before[k]["scene"] != after[k]["scene"] for k in before),
                right=sum(after[k]["right"] - before[k]["right"] for k in before),
                ari=round(statistics.fmean(after[k]["ari"] - before[k]["ari"] for k in before), 5),
                mae=round(ratio("mae", LEAST_MAE), 4), bits=round(ratio("bits", 1.0), 4))


def show(table):
    """A row per number and group of pictures, halved and doubled side by side."""
    print("| crate | number | value | pictures | changed | right | ARI | error | length |\n|---|---|---|---|---|---|---|---|---|")
    rows = {}
    for r in csv.DictReader(open(table, encoding="utf8")):
        rows.setdefault((r["crate"], r["number"], r["value"], f"{r['pictures']} {r['group']}"), []).append(r)
    for key, both in sorted(rows.items(), key=lambda row: row[0][0]):
        if any(int(r["changed"]) for r in both):
            forms = [("changed", "{}"), ("right", "{:+d}"), ("ari", "{:+.4f}"), ("mae", "{:.3f}"), ("bits", "{:.3f}")]
            of = lambda name, form: ", ".join(form.format(int(r[name]) if name in ("changed", "right") else float(r[name])) for r in both)
            print("| " + " | ".join([*key, *(of(*f) for f in forms)]) + " |")
    for crate in sorted({key[0] for key in rows}):
        names = list(dict.fromkeys(key[1] for key in rows if key[0] == crate))
        changed = {key[1] for key, both in rows.items() if key[0] == crate and any(int(r["changed"]) for r in both)}
        print(f"\nWithout an effect on these pictures, of {len(names)} numbers of `{crate}`: "
              + ", ".join(f"`{n}`" for n in names if n not in changed) + ".")


def main():
    if sys.argv[1:2] == ["show"]:
        return show(sys.argv[2])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("--crate", choices=("fit", "trace"))
    parser.add_argument("--only", help="numbers, separated by commas")
    parser.add_argument("--every", type=int, default=1, help="of the pictures of a set, one of so many")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--table", type=pathlib.Path, help="WORK/sensitivity.csv unless told; the committed one holds all numbers")
    a = parser.parse_args()
    a.work = a.work.resolve()
    a.work.mkdir(parents=True, exist_ok=True)
    code = run_with_packages(a.work)
    if code is not None:
        return code
    a.table = a.table or a.work / "sensitivity.csv"
    numbers = build(a.work)
    pictures = draw(a.work, a.every)
    with open(a.table, "w", newline="", encoding="utf8") as out:
        table = csv.DictWriter(out, ["crate", "number", "value", "factor", "group", "pictures", "changed", "right", "ari", "mae", "bits"])
        table.writeheader()
        for crate, group in GROUPS:
            if a.crate not in (None, crate):
                continue
            of_group = [p for p in pictures if p[0] == group]
            before = fit(a.work, of_group)
            print(f"{group}: {len(before)} pictures, {sum(b['right'] for b in before.values())} right", file=sys.stderr, flush=True)
            tried = [(n, v, f) for n, v in numbers[crate].items() if not a.only or n in a.only.split(",") for f in FACTORS]
            with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
                results = pool.map(lambda of: against(before, fit(a.work, of_group, of[0], of[2])), tried)
                for (name, value, factor), result in zip(tried, results):
                    table.writerow(dict(crate=crate, number=name, value=value, factor=factor, group=group, **result))
                    out.flush()


if __name__ == "__main__":
    sys.exit(main())
