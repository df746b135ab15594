"""The field's benchmarks: connected components of equal color, `dvp fit`, and `dvp fit` with shapes learned from pictures alone.

    suites.py --dvp EXE [--work DIR] [--quick]

Prints the tables of suites.md. Pictures are look-alikes that `dvp generate` draws; shapes are learned from others than they are scored on.
Nobody debugs on the seeds below: who looks at their pictures while changing the fit draws new ones. Published files are scored by the same
commands, with `dvp generate --preset NAME --from FILE` in place of the seeds.
"""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile

# Of the pictures that shapes are learned from, and of those that are scored.
SEEDS = {"multi-dsprites": (730_115_401, 730_115_402), "tetrominoes": (730_115_403, 730_115_404), "csr": (None, 730_115_406)}
LEARNED_FROM = 300
SCORED = 320
COLUMNS = {"ari_foreground": "ARI-FG", "ari": "ARI", "exact_count": "OCA", "order": "OOA", "iou": "IoU", "f1": "F1",
           "class_accuracy": "classes"}


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}: code {done.returncode}: {done.stderr[-500:]}")
    return done.stdout


def rows_of(dvp, work, suite, quick):
    """Name and figures of each method, and what learning the shapes took."""
    learned_from, scored = (60, 40) if quick else (LEARNED_FROM, SCORED)
    data = work / f"{suite}-data"
    run(dvp, "generate", "--preset", suite, "--count", scored, "--seed", SEEDS[suite][1], "--out", data)
    banks, note = {"": []}, ""
    if SEEDS[suite][0]:
        pictures, bank = work / f"{suite}-pictures", work / f"{suite}.json"
        run(dvp, "generate", "--preset", suite, "--count", learned_from, "--seed", SEEDS[suite][0], "--out", pictures)
        upright = ["--upright"] if suite == "tetrominoes" else []
        before = os.times().children_user
        shapes = json.loads(run(dvp, "prototypes", pictures, "-o", bank, "--json", "--threads", 1, *upright))["shapes"]
        spent = os.times().children_user - before
        note = f"{len(shapes)} shapes learned from {learned_from} others in {spent:.1f} s of processor time"
        banks["learned"] = ["--bank", bank]
    if suite == "multi-dsprites":
        banks["known"] = ["--bank", "mdshr"]
    rows = []
    for name, options in banks.items():
        out = work / f"{suite}-{name or 'free'}"
        fits = json.loads(run(dvp, "fit", *sorted(data.glob("*.png")), "--out", out, "--threads", 1, "--no-png", "--no-svg",
                              "--json", *options))["images"]
        times = sorted(image["cpu_ms"] for image in fits)
        components, fit = json.loads(run(dvp, "evaluate", out, data, "--suite", suite, "--json"))["rows"]
        if not rows:
            rows.append(("connected components", components, None))
        rows.append((f"dvp fit, {name} shapes" if name else "dvp fit", fit, times[len(times) // 2]))
    return rows, note, scored


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--dvp", required=True, type=pathlib.Path)
    arguments.add_argument("--work", type=pathlib.Path, help="an empty folder for pictures and fits [default: one that is removed]")
    arguments.add_argument("--quick", action="store_true", help="fewer pictures")
    arguments = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for suite in SEEDS:
            rows, note, scored = rows_of(arguments.dvp, arguments.work or pathlib.Path(folder), suite, arguments.quick)
            print(f"**{suite}**, {scored} pictures" + (f"; {note}" if note else "") + "\n")
            print("| | " + " | ".join(COLUMNS.values()) + " | ms |\n|" + "---|" * (len(COLUMNS) + 2))
            for name, figures, ms in rows:
                cells = ["-" if figures[key] is None else f"{figures[key]:.4f}" for key in COLUMNS]
                print(f"| {name} | " + " | ".join(cells) + f" | {'-' if ms is None else f'{ms:.1f}'} |")
            print(flush=True)


if __name__ == "__main__":
    main()
