"""Pictures of the kinds that people draw with programs, beside icons and charts: eight kinds, as SVG and drawn by resvg.

    kinds.py REAL.PY DIR [--seed N] [--each N]     # DIR/truth/KIND/NAME.svg, DIR/src/KIND/SIZE/NAME.png
    REAL.PY run DIR --dvp EXE --sizes 256,512 --peers; REAL.PY score DIR --sizes 256,512

Flow charts with arrows, interfaces with cards and switches, maps whose regions share wiggly borders, comic figures with an outline, Venn
circles that show through one another, isometric blocks, gauges, tiles. Text is drawn as paths. Nobody debugs on the pictures of the seed
that is the default.
"""

import argparse
import json
import math
import pathlib
import random

import numpy as np
from matplotlib.textpath import TextPath
from scipy.spatial import Voronoi

from labelled import load

SEED = 424_311
SIZES = [256, 512]
WIDTH, HEIGHT = 256, 192
COLORS = ["#4e79a7", "#f28e2b", "#e15759", "#76b7b2", "#59a14f", "#edc948", "#b07aa1", "#ff9da7", "#9c755f", "#bab0ac", "#1f77b4", "#2ca02c",
          "#d62728", "#fde725", "#440154", "#31688e"]


def element(name, **attributes):
    return f"<{name} " + " ".join(f'{key.replace("_", "-")}="{value}"' for key, value in attributes.items()) + "/>"


def rectangle(x, y, width, height, fill, **more):
    return element("rect", x=x, y=y, width=width, height=height, fill=fill, **more)


def circle(x, y, radius, fill, **more):
    return element("circle", cx=f"{x:.2f}", cy=f"{y:.2f}", r=f"{radius:.2f}", fill=fill, **more)


def polygon(points, fill, **more):
    return element("polygon", points=" ".join(f"{x:.2f},{y:.2f}" for x, y in points), fill=fill, **more)


def line(start, end, stroke, width):
    (x1, y1), (x2, y2) = start, end
    return element("line", x1=f"{x1:.2f}", y1=f"{y1:.2f}", x2=f"{x2:.2f}", y2=f"{y2:.2f}", stroke=stroke, stroke_width=width)


def text(x, y, words, size, fill, is_centered=True):
    path = TextPath((0, 0), words, size=size)
    box = path.get_extents()
    left = x - (box.x0 + box.x1) / 2 if is_centered else x - box.x0
    data = ""
    for points, code in path.iter_segments():
        data += {1: "M", 2: "L", 3: "Q", 4: "C", 79: "Z"}[code]
        data += "" if code == 79 else " ".join(f"{left + a:.3f},{y - b:.3f}" for a, b in points.reshape(-1, 2))
    return element("path", d=data, fill=fill)


def word(rng):
    return "".join(rng.choice("abcdefghiklmnoprstuvw") for _ in range(rng.randint(3, 6))).capitalize()


def flow(rng):
    places, tries = [], 0
    while len(places) < 5:
        tries += 1
        if tries % 50 == 0:
            places = []
        x, y = rng.uniform(36, 220), rng.uniform(24, 170)
        if all(abs(x - a) > 58 or abs(y - b) > 36 for a, b in places):
            places.append((x, y))
    parts = [rectangle(0, 0, WIDTH, HEIGHT, "#fff")]
    for k in range(1, len(places)):
        start, end = np.array(places[rng.randrange(k)]), np.array(places[k])
        along = (end - start) / np.linalg.norm(end - start)
        tip = end - along * min(27 / max(abs(along[0]), 1e-9), 14 / max(abs(along[1]), 1e-9))
        across = np.array([-along[1], along[0]])
        parts.append(line(start, tip - 5 * along, "#333", 1.3))
        parts.append(polygon([tip, tip - 7 * along + 3.2 * across, tip - 7 * along - 3.2 * across], "#333"))
    fill = rng.choice(["#fff", "#dae8fc", "#d5e8d4", "#fff2cc"])
    pen = dict(stroke="#333", stroke_width=1.3)
    for x, y in places:
        kind = rng.choice(["sharp", "round", "ellipse", "diamond"])
        if kind == "ellipse":
            parts.append(element("ellipse", cx=x, cy=y, rx=27, ry=14, fill=fill, **pen))
        elif kind == "diamond":
            parts.append(polygon([(x - 27, y), (x, y - 16), (x + 27, y), (x, y + 16)], fill, **pen))
        else:
            parts.append(rectangle(x - 26, y - 13, 52, 26, fill, rx=6 if kind == "round" else 0, **pen))
        parts.append(text(x, y + 3, word(rng), 9, "#222"))
    return parts


def interface(rng):
    accent, (page, card, rule, ink) = rng.choice(COLORS), rng.choice(
        [("#f5f6f8", "#fff", "#d9dce1", "#30343b"), ("#fff", "#fff", "#d9dce1", "#30343b"), ("#1e1e24", "#2b2b33", "#44444f", "#e8e8ee")])
    parts = [rectangle(0, 0, WIDTH, HEIGHT, page), rectangle(0, 0, WIDTH, 24, accent), text(10, 16, word(rng), 11, "#fff", False),
             circle(240, 12, 7, "#fff")]
    for k in range(3):
        x = 10 + 82 * k
        parts += [rectangle(x + 0.5, 34.5, 74, 62, card, rx=5, stroke=rule), circle(x + 14, 50, 8, rng.choice(COLORS)),
                  text(x + 28, 53, word(rng)[:5], 9, ink, False), text(x + 8, 72, str(rng.randint(100, 9999)), 13, ink, False),
                  rectangle(x + 8, 82, 58, 5, rule, rx=2.5), rectangle(x + 8, 82, f"{rng.uniform(10, 56):.1f}", 5, accent, rx=2.5)]
    for k in range(4):
        y, is_on = 106 + 20 * k, rng.random() < 0.5
        parts += [line((10, y + 15.5), (246, y + 15.5), rule, 1), text(14, y + 10, f"{word(rng)} {word(rng)}", 8.5, ink, False),
                  rectangle(216, y + 1, 24, 12, accent if is_on else rule, rx=6), circle(234 if is_on else 222, y + 7, 4.5, "#fff")]
    return parts


def regions(rng):
    random_of = np.random.default_rng(rng.randrange(1 << 30))
    seeds = random_of.uniform([20, 20], [236, 172], (rng.randint(9, 18), 2))
    cells = Voronoi(np.vstack([seeds, [[-300, 96], [556, 96], [128, -300], [128, 492]]]))
    borders = {}

    def border(a, b):
        """Points between two corners, the same from both sides."""
        key = min(a, b), max(a, b)
        if key not in borders:
            start, step = cells.vertices[key[0]], cells.vertices[key[1]] - cells.vertices[key[0]]
            across = np.array([-step[1], step[0]]) / max(np.linalg.norm(step), 1e-9)
            count = max(1, int(np.linalg.norm(step) / 7))
            borders[key] = [start + step * share + across * random_of.normal(0, 1.6) for share in np.linspace(0, 1, count + 1)[1:-1]]
        return borders[key] if a < b else borders[key][::-1]

    pen = dict(stroke=rng.choice(["#fff", "#000", "#666"]), stroke_width=rng.choice([0.6, 1, 1.5]), stroke_linejoin="round")
    parts = [rectangle(0, 0, WIDTH, HEIGHT, "#fff")]
    for k in range(len(seeds)):
        corners = cells.regions[cells.point_region[k]]
        if -1 not in corners:
            points = [point for a, b in zip(corners, corners[1:] + corners[:1]) for point in [cells.vertices[a], *border(a, b)]]
            parts.append(polygon(points, rng.choice(["#eff3ff", "#bdd7e7", "#6baed6", "#3182bd", "#08519c"]), **pen))
    return parts


def comic(rng):
    parts, width = [rectangle(0, 0, WIDTH, HEIGHT, rng.choice(COLORS))], rng.choice([2, 3, 4.5])
    pen = dict(stroke="#111", stroke_linejoin="round", stroke_linecap="round")
    for _ in range(rng.randint(3, 6)):
        x, y, size, count, turn = rng.uniform(30, 226), rng.uniform(30, 162), rng.uniform(18, 42), rng.randint(5, 9), rng.uniform(0, 6)
        knots = np.array([[x, y] + size * rng.uniform(0.7, 1.2) * np.array([math.cos(turn + k * math.tau / count), math.sin(turn + k * math.tau / count)])
                          for k in range(count)])
        before, behind, beyond = (np.roll(knots, shift, 0) for shift in (1, -1, -2))
        curves = zip(knots + (behind - before) / 6, behind - (beyond - knots) / 6, behind)
        data = f"M{knots[0][0]:.2f},{knots[0][1]:.2f}" + "".join("C" + " ".join(f"{a:.2f},{b:.2f}" for a, b in curve) for curve in curves) + "Z"
        parts.append(element("path", d=data, fill=rng.choice(COLORS), stroke_width=width, **pen))
        for side in (-1, 1):
            parts.append(element("ellipse", cx=f"{x + 0.3 * side * size:.2f}", cy=f"{y - 0.1 * size:.2f}", rx=f"{0.16 * size:.2f}",
                                 ry=f"{0.2 * size:.2f}", fill="#fff", stroke_width=0.6 * width, **pen))
            parts.append(circle(x + 0.3 * side * size, y - 0.06 * size, 0.07 * size, "#111"))
        smile = f"M{x - 0.3 * size:.2f},{y + 0.3 * size:.2f}Q{x:.2f},{y + 0.55 * size:.2f} {x + 0.3 * size:.2f},{y + 0.3 * size:.2f}"
        parts.append(element("path", d=smile, fill="none", stroke_width=0.8 * width, **pen))
    return parts


def venn(rng):
    count = rng.randint(2, 4)
    at = lambda k, far: (128 + far * math.cos(math.tau * k / count + 0.5), 96 + far * math.sin(math.tau * k / count + 0.5))
    circles = [circle(*at(k, 34), rng.uniform(42, 54), rng.choice(COLORS[:8]), fill_opacity=rng.choice([0.4, 0.5, 0.6])) for k in range(count)]
    letters = [text(at(k, 55)[0], at(k, 55)[1] + 4, rng.choice("ABCXYZ"), 12, "#222") for k in range(count)]
    return [rectangle(0, 0, WIDTH, HEIGHT, "#fff"), *circles, *letters]


def blocks(rng):
    parts, side = [rectangle(0, 0, WIDTH, HEIGHT, rng.choice(["#fff", "#eef", "#223"]))], rng.uniform(18, 24)
    hues = rng.sample([(78, 121, 167), (242, 142, 43), (89, 161, 79), (225, 87, 89)], 2)
    across, down = 0.866 * side, 0.5 * side
    for i, j in [(i, j) for i in range(4) for j in range(4)]:
        height, hue = 0.6 * side * rng.randint(0, 3), rng.choice(hues)
        shade = lambda factor: "#%02x%02x%02x" % tuple(min(255, int(value * factor)) for value in hue)
        x, y = 128 + (i - j) * across, 120 + (i + j - 4) * down
        top, left, right, near = (x, y - height), (x - across, y + down - height), (x + across, y + down - height), (x, y + 2 * down - height)
        low = lambda point: (point[0], point[1] + height)
        if height > 0:
            parts += [polygon([top, right, near, left], shade(1.15)), polygon([left, near, low(near), low(left)], shade(0.85)),
                      polygon([right, near, low(near), low(right)], shade(0.65))]
    return parts


def gauge(rng):
    radius, width, first, whole = rng.uniform(62, 78), rng.uniform(8, 18), math.radians(150), math.radians(240)
    at = lambda share, far: (128 + far * math.cos(first + share * whole), 110 + far * math.sin(first + share * whole))
    parts = [rectangle(0, 0, WIDTH, HEIGHT, "#fafafa")]
    for k, color in enumerate(rng.sample(COLORS, 4)):
        (x1, y1), (x2, y2) = at(k / 4, radius), at((k + 1) / 4, radius)
        arc = f"M{x1:.3f},{y1:.3f}A{radius:.2f},{radius:.2f} 0 0 1 {x2:.3f},{y2:.3f}"
        parts.append(element("path", d=arc, fill="none", stroke=color, stroke_width=f"{width:.2f}"))
    for k in range(13):
        outer, inner = radius - width / 2 - 4, radius - width / 2 - (12 if k % 3 == 0 else 9)
        parts.append(line(at(k / 12, outer), at(k / 12, inner), "#444", 1.8 if k % 3 == 0 else 1))
        if k % 3 == 0:
            x, y = at(k / 12, inner - 9)
            parts.append(text(x, y + 3, str(10 * k), 7.5, "#444"))
    share = rng.random()
    (x, y), turn = at(share, radius - 20), first + share * whole
    foot = [(128 + side * 4 * math.sin(turn), 110 - side * 4 * math.cos(turn)) for side in (-1, 1)]
    return [*parts, polygon([(x, y), *foot], "#c0392b"), circle(128, 110, 7, "#333"), circle(128, 110, 3, "#ccc")]


def tiles(rng):
    side, gap, colors = rng.choice([24, 32]), rng.choice([0, 1, 2]), rng.sample(COLORS, 5)
    parts, size = [rectangle(0, 0, WIDTH, HEIGHT, "#fff")], side - gap
    for x, y in [(x + gap / 2, y + gap / 2) for y in range(0, HEIGHT, side) for x in range(0, WIDTH, side)]:
        parts.append(rectangle(x, y, size, size, colors[0]))
        parts.append([lambda: element("path", d=f"M{x},{y}h{size}a{size},{size} 0 0 1 {-size},{size}z", fill=colors[1]),
                      lambda: polygon([(x, y), (x + size, y), (x, y + size)], colors[2]),
                      lambda: circle(x + size / 2, y + size / 2, 0.32 * size, colors[3]),
                      lambda: rectangle(x + size / 4, y + size / 4, size / 2, size / 2, colors[4])][rng.randrange(4)]())
    return parts


KINDS = [flow, interface, regions, comic, venn, blocks, gauge, tiles]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("script")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--each", type=int, default=10)
    given = parser.parse_args()
    folder, jobs = given.folder.absolute(), []
    for kind in KINDS:
        truth = folder / "truth" / kind.__name__
        truth.mkdir(parents=True, exist_ok=True)
        for number in range(given.each):
            name = f"{kind.__name__}{number}"
            parts = kind(random.Random(f"{given.seed} {name}"))
            (truth / f"{name}.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}">{"".join(parts)}</svg>')
            jobs += [dict(src=f"{truth}/{name}.svg", out=f"{folder}/src/{kind.__name__}/{width}/{name}.png", width=width)
                     for size in SIZES for width in (size, 4 * size)]
    (folder / "sets.json").write_text(json.dumps({kind.__name__: {} for kind in KINDS}))
    real = load(given.script)
    real.tools(str(folder))
    real.draw(str(folder), jobs)


if __name__ == "__main__":
    main()
