"""Charts and diagrams with labels, as matplotlib draws them: letters of a few pixels, thin lines that meet, dashes.

    labelled.py make REAL.PY DIR [--seed N]     # draws 40 of them: DIR/truth/labelled/NAME.svg, DIR/src/labelled/SIZE/NAME.png
    labelled.py both REAL.PY DIR EXE            # fits and scores them with one program: one line

Eight kinds, five of each: histograms, lines with a legend, bars with dashed grid lines, candles, graphs of knots and edges, flow charts,
polar lines, arrows. Text is drawn as paths; resvg draws the pictures, at 256 and 400 px and at four times that, and REAL.PY
(`real.py` of the shared data) scores them as all others. Nobody debugs on the pictures of the seed that is the default.
"""

import argparse
import importlib.util
import json
import os
import pathlib
import subprocess
import sys

import numpy as np

KINDS = ["histogram", "legend", "gantt", "candles", "graph", "flow", "polar", "arrows"]
EACH = 5
SIZES = [256, 400]
SEED = 901_127
SIDE = 3.2


def draw(kind, rng, path):
    """One picture, as SVG."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import patches, pyplot
    matplotlib.rcParams["svg.fonttype"] = "path"
    colors = [f"C{k}" for k in rng.permutation(10)]
    figure = pyplot.figure(figsize=(SIDE, SIDE))
    axes = figure.add_subplot(projection="polar" if kind == "polar" else None)
    if kind == "histogram":
        axes.hist(rng.normal(size=400), int(rng.integers(8, 20)), color=colors[0], edgecolor="white")
        axes.set_title("Values")
    elif kind == "legend":
        for k in range(3):
            axes.plot(np.cumsum(rng.normal(size=12)), color=colors[k], label="abc"[k], marker="o" if k else None, markersize=4)
        axes.legend()
    elif kind == "gantt":
        for k in range(6):
            axes.barh(k, rng.uniform(1, 4), left=rng.uniform(0, 5), color=colors[k % 4], edgecolor="black")
        axes.grid(axis="x", linestyle="--")
    elif kind == "candles":
        for k in range(12):
            start, end = rng.uniform(2, 6, 2)
            low, high = min(start, end), max(start, end)
            axes.plot([k, k], [low - rng.uniform(0, 1), high + rng.uniform(0, 1)], color="black", linewidth=1)
            axes.add_patch(patches.Rectangle((k - 0.3, low), 0.6, high - low, facecolor="green" if end > start else "red",
                                             edgecolor="black"))
    elif kind == "graph":
        axes.axis("off")
        axes.set_aspect("equal")
        places = rng.uniform(0, 1, (9, 2))
        for i in range(9):
            for j in np.argsort(((places - places[i]) ** 2).sum(1))[1:3]:
                axes.plot(*places[[i, j]].T, color="#888888", linewidth=1.2, zorder=1)
        axes.scatter(*places.T, s=120, color=[colors[i % 5] for i in range(9)], edgecolors="black", zorder=2)
        for i, (x, y) in enumerate(places):
            axes.text(x, y + 0.06, "ABCDEFGHI"[i], ha="center")
    elif kind == "flow":
        axes.axis("off")
        axes.set(xlim=(0, 8), ylim=(0, 8))
        names = list(rng.permutation(["Start", "Read", "Work", "Check", "Store", "End"]))
        corners = [(0.6, 6.2), (4.8, 6.2), (4.8, 3.4), (0.6, 3.4)]
        for k, (x, y) in enumerate(corners):
            box = patches.FancyBboxPatch((x, y), 2.4, 1.1, boxstyle="round,pad=0.1", edgecolor="black", linewidth=1.2,
                                         facecolor=np.append(0.5 + 0.5 * rng.uniform(size=3), 1))
            axes.add_patch(box)
            axes.text(x + 1.2, y + 0.55, names[k], ha="center", va="center", fontsize=9)
        for a, b in [((3.2, 6.8), (4.6, 6.8)), ((6.0, 6.0), (6.0, 4.7)), ((4.6, 4.0), (3.2, 4.0))]:
            axes.annotate("", b, a, arrowprops=dict(arrowstyle="-|>", color="black"))
    elif kind == "polar":
        turn = np.linspace(0, 2 * np.pi, 200)
        axes.plot(turn, 1 + rng.uniform(0.2, 0.6) * np.sin(rng.integers(2, 6) * turn), color=colors[0])
        axes.fill(turn, 0.6 + 0.2 * np.cos(rng.integers(2, 4) * turn), color=colors[1])
    elif kind == "arrows":
        x, y = np.meshgrid(range(7), range(6))
        axes.quiver(x, y, np.cos(x * rng.uniform(0.2, 0.8)), np.sin(y * rng.uniform(0.2, 0.9)), color=colors[0])
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


def load(script):
    """`real.py` as a module."""
    spec = importlib.util.spec_from_file_location("real", script)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def make(script, folder, seed):
    truth = folder / "truth/labelled"
    truth.mkdir(parents=True, exist_ok=True)
    (folder / "sets.json").write_text("{}")
    names = [f"{kind}{number}" for kind in KINDS for number in range(EACH)]
    for k, name in enumerate(names):
        draw(name[:-1], np.random.default_rng([seed, k]), truth / f"{name}.svg")
    real = load(script)
    real.tools(str(folder))
    real.draw(str(folder), [dict(src=f"{truth}/{name}.svg", out=f"{folder}/src/labelled/{width}/{name}.png", width=width)
                            for name in names for size in SIZES for width in (size, 4 * size)])


def both(script, folder, program):
    sizes = ",".join(map(str, SIZES))
    tool = lambda *words: subprocess.run([sys.executable, script, *words], check=True, stdout=subprocess.DEVNULL)
    for file in folder.glob("scores-dvp.json"):
        file.unlink()
    tool("run", str(folder), "--dvp", os.path.abspath(program), "--sizes", sizes)
    tool("score", str(folder), "--sizes", sizes)
    scores = json.loads((folder / "scores-dvp.json").read_text())
    runs = [json.loads(line) for line in (folder / "runs.jsonl").read_text().splitlines()]
    for size in SIZES:
        of_size = [score for name, score in scores.items() if f"/{size}/" in name]
        means = {key: float(np.mean([score[key] for score in of_size])) for key in ("bad", "missed", "dE", "dist")}
        times = [run["ms"] for run in runs if run["method"] == "dvp" and str(run["size"]) == str(size)]
        print(size, len(of_size), {key: round(value, 3) for key, value in means.items()},
              f"median {np.median(times):.0f} ms, most {max(times):.0f} ms")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("do", choices=["make", "both"])
    parser.add_argument("script")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("program", nargs="?")
    parser.add_argument("--seed", type=int, default=SEED)
    given = parser.parse_args()
    if given.do == "make":
        make(given.script, given.folder.absolute(), given.seed)
    else:
        both(given.script, given.folder.absolute(), given.program)


if __name__ == "__main__":
    main()
