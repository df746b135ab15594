#!/usr/bin/env python3
"""Which of an artist's numbers come back exactly.

    grid.py ARTIST OURS [--units 24] [--step 0.25] [--each]

ARTIST and OURS are folders of SVG files of the same names. Numbers are the coordinates of the ends of lines, arcs and cubics, centers
and radii of arcs and circles, and widths of strokes, in units of which the artist's view box is --units wide (16 for sets drawn on
16). Only the artist's numbers on multiples of --step count. A point (the end of a piece, a center) comes back if ours has one within
0.002 units in both coordinates (they are written to 0.01 pixels); a radius or width likewise. `on grid`: share of the artist's points, radii and widths that lie on the
grid; `exact`: share of these that come back, and, as `near`, within 0.1 units, which says what the fit has at all.

Columns: set of files, pictures, points (on grid, exact, near), radii and widths (on grid, exact, near), all numbers exact.
Fills of strokes and strokes are told apart: an artist's stroke that comes back filled gives back nothing.
"""

import argparse
import math
import pathlib
import re
import xml.etree.ElementTree as tree

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
COUNTS = dict(M=2, L=2, H=1, V=1, C=6, S=4, Q=4, T=2, A=7, Z=0)


def commands(path):
    """The commands of path data, each with its letter and numbers; flags of arcs may stick to what follows."""
    for letter, text in re.findall(r"([a-zA-Z])([^a-zA-Z]*)", re.sub(r"[eE]", "e", path).replace("e-", "E-") if "e" in path else path):
        count = COUNTS.get(letter.upper(), 0)
        if count == 0:
            yield letter, []
            continue
        numbers, at = [], 0
        while True:
            is_flag = letter in "aA" and len(numbers) % 7 in (3, 4)
            while at < len(text) and text[at] in " ,\n\t\r":
                at += 1
            if at >= len(text):
                break
            match = re.compile("[01]").match(text, at) if is_flag else NUMBER.match(text, at)
            if not match:
                break
            numbers.append(float(match.group()))
            at = match.end()
        for first in range(0, len(numbers) - count + 1, count):
            yield letter, numbers[first : first + count]
            letter = {"M": "L", "m": "l"}.get(letter, letter)


def center(start, end, radius, large, sweep):
    """Center and radius of a circular arc: as SVG says, a radius too small for its chord grows."""
    middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    half = math.dist(start, end) / 2
    if half == 0:
        return None
    radius = max(radius, half)
    height = math.sqrt(max(0.0, radius * radius - half * half)) * (1 if large != sweep else -1)
    across = ((start[1] - end[1]) / 2 / half, (end[0] - start[0]) / 2 / half)
    return (middle[0] + across[0] * height, middle[1] + across[1] * height), radius


def of_path(path, points, lengths):
    """Adds the points and radii of path data."""
    here = start = (0.0, 0.0)
    for letter, numbers in commands(path):
        kind, relative = letter.upper(), letter.islower()
        base = here if relative else (0.0, 0.0)
        if kind == "Z":
            here = start
            continue
        if kind == "H":
            end = (base[0] + numbers[0], here[1])
        elif kind == "V":
            end = (here[0], base[1] + numbers[0])
        else:
            end = (base[0] + numbers[-2], base[1] + numbers[-1])
        if kind == "M":
            start = end
        if kind == "A" and numbers[0] == numbers[1]:
            circle = center(here, end, numbers[0], numbers[3] > 0, numbers[4] > 0)
            if circle:
                points.append(circle[0])
                lengths.append(circle[1])
        points.append(end)
        here = end


def numbers_of(file, units):
    """Points and lengths of a file, in units."""
    root = tree.parse(file).getroot()
    box = [float(v) for v in NUMBER.findall(root.get("viewBox", f"0 0 {units} {units}"))]
    points, lengths = [], []
    visit(root, points, lengths)
    scale = units / box[2]
    place = lambda point: ((point[0] - box[0]) * scale, (point[1] - box[1]) * scale)
    return [place(point) for point in points], [length * scale for length in lengths]


def visit(element, points, lengths, stroke=None):
    """Adds what an element and those in it draw."""
    tag = element.tag.rsplit("}", 1)[-1]
    get = lambda name: float((element.get(name) or "0").rstrip("%px"))
    stroke = element.get("stroke-width", stroke)
    drawn = len(points)
    if tag == "path":
        of_path(element.get("d", ""), points, lengths)
    elif tag in ("circle", "ellipse"):
        points.append((get("cx"), get("cy")))
        lengths.extend([get("r")] if tag == "circle" else [get("rx"), get("ry")])
    elif tag == "line":
        points.extend([(get("x1"), get("y1")), (get("x2"), get("y2"))])
    elif tag == "rect" and element.get("width", "").endswith("%") is False:
        x, y, width, height = get("x"), get("y"), get("width"), get("height")
        radius = get("rx") or get("ry")
        if radius:
            # A path of lines and arcs says the same.
            points.extend((u, v) for u in (x + radius, x + width - radius) for v in (y, y + height, y + radius, y + height - radius))
            points.extend((u, v) for u in (x, x + width) for v in (y + radius, y + height - radius))
            lengths.append(radius)
        else:
            points.extend((u, v) for u in (x, x + width) for v in (y, y + height))
    elif tag in ("polyline", "polygon"):
        values = [float(v) for v in NUMBER.findall(element.get("points", ""))]
        points.extend(zip(values[::2], values[1::2]))
    if stroke and len(points) > drawn:
        lengths.append(float(stroke))
    for child in element:
        visit(child, points, lengths, stroke)


def shares(wanted, found, step, distance):
    """How many are wanted, on the grid, exact and near."""
    is_on = lambda value: abs(value / step - round(value / step)) * step < 1e-3
    grid = [value for value in wanted if (all(map(is_on, value)) if isinstance(value, tuple) else is_on(value))]
    misses = [min((distance(value, other) for other in found), default=math.inf) for value in grid]
    return [len(wanted), len(grid), sum(miss <= 0.002 for miss in misses), sum(miss <= 0.1 for miss in misses)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("artist", type=pathlib.Path)
    parser.add_argument("ours", type=pathlib.Path)
    parser.add_argument("--units", type=float, default=24)
    parser.add_argument("--step", type=float, default=0.25)
    parser.add_argument("--each", action="store_true", help="a line for each picture")
    options = parser.parse_args()
    totals, pictures = [[0] * 4, [0] * 4], 0
    for file in sorted(options.artist.glob("*.svg")):
        ours = options.ours / file.name
        if not ours.exists():
            continue
        (points, lengths), (our_points, our_lengths) = numbers_of(file, options.units), numbers_of(ours, options.units)
        farther = lambda a, b: max(abs(a[0] - b[0]), abs(a[1] - b[1]))
        rows = [
            shares(list(dict.fromkeys(points)), our_points, options.step, farther),
            shares(list(dict.fromkeys(lengths)), our_lengths, options.step, lambda a, b: abs(a - b)),
        ]
        totals = [[a + b for a, b in zip(total, row)] for total, row in zip(totals, rows)]
        pictures += 1
        if options.each:
            print(f"{file.stem:32} points {rows[0]} lengths {rows[1]}")
    text = [f"{options.artist.name:16} {pictures:4}"]
    for name, (wanted, grid, exact, near) in zip(("points", "lengths"), totals):
        text.append(f"{name}: on grid {grid}/{wanted} exact {exact / max(grid, 1):.1%} near {near / max(grid, 1):.1%}")
    grid, exact = (2 * totals[0][k] + totals[1][k] for k in (1, 2))
    print("  ".join(text), f" numbers exact {exact / max(grid, 1):.1%}")


if __name__ == "__main__":
    main()
