"""Charts as matplotlib draws them, with the truth about their marks, and a score of what a fit makes of them.

    charts.py DIR        # draws the 35 charts: DIR/truth/charts/NAME.svg, NAME.json and NAME.labels.png

Bars, pies, scatter plots, lines, box plots, areas and heat maps, five of each, from fixed seeds; an axes frame (pies have none), no
text, no ticks. The picture set of a size is the SVG drawn by resvg, as all of `real.py`; `agg256` holds matplotlib's own PNG, in
which frames and boxes are moved to the pixel grid.

**Marks** are what a reader counts: bars, wedges, points, lines, boxes, areas, cells. Frame, medians, whiskers and caps are not
counted, and a program may do with them what it likes. NAME.labels.png, FINE px wide, tells which mark is seen where.

**The count is right** if every mark is found and none is invented:

- An object *belongs to* the mark on which at least half of what is seen of it lies, if its color is within NEAR_COLOR of the
  mark's in every channel. What is seen of an object is its whole coverage less that of the objects in front.
- A mark is *found* if exactly one object belongs to it and they share at least half of what is seen of the mark.
- An object is *invented* if it belongs to no mark, shows at least LEAST_INVENTED px, and has the color of some mark and not the
  background's.

Marks may be seen in pieces (boxes behind their median, lines at crossings), and are to be one object all the same.

**Destroyed** are pictures with more than 10 % of pixels off by more than 0.1 in some channel at 4x (`bad` of `real.py`). A chart of
thin lines that comes back empty is off in 3 % of its pixels only: `half_missed` are pictures that miss more than half of their
outlines (`missed` of `real.py`), of which the frame is a large part.
Moving frames and boxes to the grid alone, as in `agg256`, takes 1.4 % of the pixels at most.
"""

import io
import json
import pathlib
import sys

import numpy as np
from PIL import Image

KINDS = ["bars", "pie", "scatter", "lines", "boxplot", "area", "heatmap"]
EACH = 5
SIZES = [128, 256, 512]
# Inches; the picture is square.
SIDE = 3.0
FINE = 2048
NEAR_COLOR = 0.2
LEAST_INVENTED = 2.0
# Nobody debugs on these pictures.
SEED = 611_953

PALETTES = [
    ["#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#e377c2", "#17becf"],
    ["#4c72b0", "#dd8452", "#55a868", "#c44e52", "#8172b3", "#937860", "#da8bc3", "#64b5cd"],
    ["#003f5c", "#58508d", "#bc5090", "#ff6361", "#ffa600", "#2a9d8f", "#7a5195", "#e9c46a"],
]


class Chart:
    """Draws one chart; `is_truth` draws each mark in a color that tells its number and all else in black."""

    def __init__(self, kind, number, is_truth):
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        matplotlib.rcParams["path.snap"] = not is_truth
        matplotlib.rcParams["svg.hashsalt"] = "charts"
        self.random = np.random.default_rng([SEED, KINDS.index(kind), number])
        self.is_truth, self.number = is_truth, number
        self.colors, self.marks = PALETTES[number % len(PALETTES)], []
        self.figure = pyplot.figure(figsize=(SIDE, SIDE), facecolor="black" if is_truth else "white")
        self.axes = self.figure.add_axes([0.08, 0.08, 0.84, 0.84], facecolor="black" if is_truth else "white")
        self.axes.set_xticks([]), self.axes.set_yticks([])
        getattr(self, kind)()
        if is_truth:
            for artist in self.figure.findobj(lambda artist: hasattr(artist, "set_antialiased")):
                artist.set_antialiased(False)
        for spine in self.axes.spines.values():
            spine.set_edgecolor("black")
        self.axes.set_xticks([]), self.axes.set_yticks([])

    def mark(self, color):
        """The color that the next mark is drawn in."""
        from matplotlib.colors import to_rgb
        self.marks.append([round(c, 4) for c in to_rgb(color)])
        count = len(self.marks)
        return (count % 16 * 16 / 255, count // 16 * 16 / 255, 1.0) if self.is_truth else color

    def other(self, color="black"):
        """The color of what is no mark."""
        return "black" if self.is_truth else color

    def bars(self):
        count, edge = self.random.integers(4, 9), ["none", "black"][self.number % 2]
        heights = self.random.uniform(0.15, 1.0, count)
        is_one_color = self.number in (0, 3)
        for i, height in enumerate(heights):
            color = self.mark(self.colors[0 if is_one_color else i % 8])
            bar = self.axes.barh if self.number == 4 else self.axes.bar
            bar(i, height, 0.7, color=color, edgecolor=self.other(edge) if edge != "none" else "none", linewidth=0.8)

    def pie(self):
        shares = self.random.uniform(0.4, 1.6, self.random.integers(3, 8))
        colors = [self.mark(self.colors[i % 8]) for i in range(len(shares))]
        edge = dict(edgecolor=self.other("white"), linewidth=1.0) if self.number % 2 else {}
        if self.number == 4:
            edge["width"] = 0.45
        self.axes.pie(shares, colors=colors, startangle=float(self.random.uniform(0, 360)), wedgeprops=edge)

    def scatter(self):
        radius, points = [0.022, 0.026, 0.03, 0.035, 0.028][self.number], []
        for at in self.random.uniform(0.06, 0.94, (4000, 2)):
            if len(points) < [12, 18, 14, 9, 24][self.number] and all(np.hypot(*(at - p)) > 2.8 * radius for p in points):
                points.append(at)
        colors = [self.mark(self.colors[i % [1, 3, 2, 4, 1][self.number]]) for i in range(len(points))]
        # Points of a marker of this diameter; the axes are 0.84 of the side.
        diameter = 2 * radius * 0.84 * SIDE * 72
        for at, color in zip(points, colors):
            self.axes.scatter(*at, s=diameter**2, color=color, marker="o" if self.number != 3 else "s", linewidths=0)
        self.axes.set_xlim(0, 1), self.axes.set_ylim(0, 1)

    def lines(self):
        x = np.linspace(0, 1, 13 if self.number % 2 else 200)
        for i in range([2, 3, 3, 4, 2][self.number]):
            phase, rate, slope = self.random.uniform(0, 6.28), self.random.uniform(2, 7), self.random.uniform(-0.6, 0.6)
            y = 0.25 * np.sin(rate * x + phase) + slope * x + 0.15 * i
            self.axes.plot(x, y, color=self.mark(self.colors[i]), linewidth=[2.0, 2.5, 3.0, 2.5, 3.5][self.number],
                           solid_capstyle="butt")

    def boxplot(self):
        count = int(self.random.integers(3, 6))
        data = [self.random.normal(self.random.uniform(-1, 1), self.random.uniform(0.5, 1.2), 60) for _ in range(count)]
        line = dict(color=self.other(), linewidth=1.0)
        plot = self.axes.boxplot(data, patch_artist=True, widths=0.55, showfliers=False, whiskerprops=line, capprops=line,
                                 boxprops=dict(edgecolor=self.other(), linewidth=1.0),
                                 medianprops=dict(color=self.other("white"), linewidth=1.5))
        for i, box in enumerate(plot["boxes"]):
            box.set_facecolor(self.mark(self.colors[0 if self.number == 0 else i]))
        self.axes.set_xticks([]), self.axes.set_yticks([])

    def area(self):
        count = [2, 3, 4, 3, 1][self.number]
        x = np.linspace(0, 1, 12 if self.number % 2 else 100)
        layers = [0.35 + 0.2 * np.sin(self.random.uniform(3, 8) * x + self.random.uniform(0, 6.28)) for _ in range(count)]
        self.axes.stackplot(x, layers, colors=[self.mark(self.colors[i]) for i in range(count)])
        self.axes.set_xlim(0, 1), self.axes.set_ylim(0, 1.15 * np.sum(layers, 0).max())

    def heatmap(self):
        import matplotlib
        from matplotlib.patches import Rectangle
        side, steps = [3, 4, 5, 6, 4][self.number], 9
        values = np.zeros((side, side), int)
        for i, j in np.ndindex(side, side):
            # Neighbors differ by two steps at least, for two cells of one color are one mark to every reader.
            beside = [values[i - 1, j]] * (i > 0) + [values[i, j - 1]] * (j > 0)
            free = [v for v in range(steps) if all(abs(v - b) >= 2 for b in beside)]
            values[i, j] = free[self.random.integers(len(free))]
        tones = matplotlib.colormaps[["viridis", "plasma", "Blues", "RdYlGn", "cividis"][self.number]]
        for i, j in np.ndindex(side, side):
            color = matplotlib.colors.to_hex(tones((values[i, j] + 1) / (steps + 1)))
            self.axes.add_patch(Rectangle((j, i), 1, 1, facecolor=self.mark(color), edgecolor="none", linewidth=0))
        self.axes.set_xlim(0, side), self.axes.set_ylim(0, side)

    def saved(self, **how):
        from matplotlib import pyplot
        file = io.BytesIO()
        self.figure.savefig(file, facecolor=self.figure.get_facecolor(), **how)
        pyplot.close(self.figure)
        return file.getvalue()


def names():
    return [f"{kind}{number}" for kind in KINDS for number in range(EACH)]


def make(folder):
    """Draws all charts: SVG, truth, and matplotlib's own PNG of 256 px."""
    truth, png = pathlib.Path(folder) / "truth/charts", pathlib.Path(folder) / "agg256"
    truth.mkdir(parents=True, exist_ok=True), png.mkdir(parents=True, exist_ok=True)
    for name in names():
        chart = Chart(name[:-1], int(name[-1]), False)
        svg = chart.saved(format="svg", metadata={"Date": None})
        (truth / f"{name}.svg").write_bytes(svg)
        (png / f"{name}.png").write_bytes(Chart(name[:-1], int(name[-1]), False).saved(format="png", dpi=256 / SIDE))
        drawn = Chart(name[:-1], int(name[-1]), True).saved(format="png", dpi=FINE / SIDE)
        code = np.asarray(Image.open(io.BytesIO(drawn)).convert("RGB")).astype(int)
        labels = np.where(code[..., 2] == 255, code[..., 0] // 16 + 16 * (code[..., 1] // 16), 0).astype(np.uint8)
        Image.fromarray(labels).save(truth / f"{name}.labels.png")
        marks = []
        for k, color in enumerate(chart.marks, 1):
            rows, columns = np.nonzero(labels == k)
            # Pixels of a picture whose side is 1.
            box = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1] if len(rows) else [0, 0, 0, 0]
            marks.append(dict(color=color, box=[round(float(b) / FINE, 5) for b in box]))
        (truth / f"{name}.json").write_text(json.dumps(dict(kind=name[:-1], marks=marks)) + "\n")


def wrecks(bad, missed):
    """Scores from the shares, in percent, of pixels that are off and of outlines that are missing."""
    return dict(destroyed=bad > 10, half_missed=missed > 50)


def seen(whole):
    """What is seen of objects (objects, rows, columns), of which later ones hide earlier ones."""
    left, out = np.ones(whole.shape[1:], np.float32), np.zeros_like(whole)
    for k in range(len(whole) - 1, -1, -1):
        out[k] = whole[k] * left
        left = left * (1 - whole[k])
    return out


def count(truth, name, whole, colors):
    """Whether the count of marks is right, how many there are and how many were found.

    `whole`: coverage of the objects (objects, rows, columns), in the order of painting; `colors`: theirs, 0 to 1.
    """
    marks = json.loads((pathlib.Path(truth) / f"{name}.json").read_text())["marks"]
    fine = np.asarray(Image.open(pathlib.Path(truth) / f"{name}.labels.png"))
    side = whole.shape[1]
    step = FINE // side
    shown = [(fine == k).reshape(side, step, side, step).mean((1, 3), dtype=np.float32) for k in range(1, len(marks) + 1)]
    true_colors = np.array([mark["color"] for mark in marks])
    owned, invented = [[] for _ in marks], 0
    for visible, color in zip(seen(whole), np.asarray(colors).reshape(-1, 3)):
        area = float(visible.sum())
        shared = [float(np.minimum(visible, mark).sum()) for mark in shown]
        away = np.abs(true_colors - color).max(1)
        k = int(np.argmax(shared))
        if area > 0 and shared[k] >= 0.5 * area and away[k] <= NEAR_COLOR:
            owned[k].append(shared[k])
        elif area >= LEAST_INVENTED and away.min() <= 0.1 and np.abs(1 - color).max() > 0.05:
            invented += 1
    found = [len(own) == 1 and own[0] >= 0.5 * float(mark.sum()) for own, mark in zip(owned, shown)]
    return dict(right=all(found) and invented == 0, objects=len(marks), found=sum(found), invented=invented)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    make(sys.argv[1])
