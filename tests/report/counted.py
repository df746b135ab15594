"""The table of a report that counts things in drawn pictures: `dvp fit` beside other methods, kind of picture by kind."""

import argparse
import pathlib
import tempfile

import numpy as np
from PIL import Image


def arguments(seed):
    """The options that all these reports have."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--dvp", required=True)
    parser.add_argument("--other")
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=12)
    parser.add_argument("--seed", type=int, default=seed)
    return parser.parse_args()


def table(args, kinds, drawn, peers, fitted, score):
    """Prints the share of pictures with the right count, and the mean overlap.

    `kinds`: name and what `drawn(random, *what)` takes, which gives a picture and its truth; `peers`: name and what finds things in a picture;
    `fitted(dvp, files, out)`: what a program finds in each; `score(truth, found)`: whether the count is right, and the overlap.
    """
    work = args.work or pathlib.Path(tempfile.mkdtemp())
    programs = {**({"other": args.other} if args.other else {}), "dvp": args.dvp}
    methods = [*peers, *programs]
    print("| picture | " + " | ".join(f"{method}: right | IoU" for method in methods) + " |")
    print("|---|" + "---|" * 2 * len(methods))
    rows = []
    for k, (name, *what) in enumerate(kinds):
        random = np.random.default_rng([args.seed, k])
        folder = work / f"kind{k}"
        folder.mkdir(parents=True, exist_ok=True)
        pictures, truths = zip(*(drawn(random, *what) for _ in range(args.count)))
        files = [folder / f"{i:02}.png" for i in range(args.count)]
        for file, picture in zip(files, pictures):
            Image.fromarray(picture).save(file)
        found = {method: [find(picture) for picture in pictures] for method, find in peers.items()}
        found |= {method: fitted(dvp, files, folder / method) for method, dvp in programs.items()}
        scores = [[score(truth, things) for truth, things in zip(truths, found[method])] for method in methods]
        rows.append(np.mean(scores, axis=1).ravel())
        line(name, rows[-1])
    line("all", np.mean(rows, axis=0))


def line(name, cells):
    print(f"| {name} | " + " | ".join(f"{right:.2f} | {iou:.3f}" for right, iou in zip(cells[::2], cells[1::2])) + " |", flush=True)
