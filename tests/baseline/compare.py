"""Tables of records, and which pictures got worse."""

import math
import statistics

# (score, whether more is better, tolerance as a share of the value before, tolerance on top, which middle the table shows)
SCORES = [
    ("right", True, 0, 0, "mean"),
    ("ari", True, 0, 0.002, "mean"),
    ("ari_objects", True, 0, 0.002, "mean"),
    ("whole_iou", True, 0, 0.005, "mean"),
    ("mae", False, 0.05, 2e-5, "mean"),
    ("destroyed", False, 0, 0, "mean"),
    ("half_missed", False, 0, 0, "mean"),
    ("bad", False, 0.05, 0.05, "mean"),
    ("dE", False, 0.05, 0.02, "mean"),
    ("dist", False, 0.05, 0.01, "mean"),
    ("missed", False, 0.05, 0.1, "mean"),
    ("numbers", False, 0.02, 0.05, "median"),
    ("center", False, 0.1, 0.0005, "mean"),
    ("radius", False, 0.1, 0.0005, "mean"),
    ("axes", False, 0.1, 0.001, "mean"),
    # The machine is shared: times of single pictures swing.
    ("ms", False, 1.0, 20.0, "median"),
]
# Two programs need not measure bits with one ruler, and a doubt is neither good nor bad: both are shown, not judged.
SHOWN = [("bits", "median"), ("doubted", "mean")]


def values(pictures, score):
    return [float(p[score]) for p in pictures.values() if p.get(score) is not None]


def middle(pictures, score, how):
    """Mean or median; none where no picture has the score."""
    found = values(pictures, score)
    return None if not found else statistics.median(found) if how == "median" else statistics.fmean(found)


def spread(pictures):
    """Root mean square of the errors in stated standard deviations, by kind: 1 where the deviations are right."""
    keys = sorted({key for p in pictures.values() for key in p if key.startswith("z_")})
    return {key: math.sqrt(statistics.fmean(z * z for z in values(pictures, key))) for key in keys}


def number(value):
    if value is None:
        return "-"
    digits = 5 if abs(value) < 0.01 else 4 if abs(value) < 1 else 3 if abs(value) < 10 else 1
    return "0" if value == 0 else f"{value:.{digits}f}"


def row(pictures):
    """All middles of a set, by score."""
    out = {score: middle(pictures, score, how) for score, *_, how in SCORES} | {s: middle(pictures, s, how) for s, how in SHOWN}
    return {k: v for k, v in (out | spread(pictures)).items() if v is not None}


def show(record):
    """A markdown table per kind of scores: means, of numbers, ms and bits medians."""
    kinds = {}
    for name, pictures in record["sets"].items():
        if pictures:
            kinds.setdefault(tuple(row(pictures)), []).append(name)
    lines = []
    for scores, names in kinds.items():
        lines += ["", "| set | pictures | " + " | ".join(scores) + " |", "|---" * (len(scores) + 2) + "|"]
        for name in names:
            pictures = record["sets"][name]
            lines.append(f"| {name} | {len(pictures)} | " + " | ".join(number(v) for v in row(pictures).values()) + " |")
    lines += ["", *(f"Skipped: {what}" for what in record["skipped"])]
    return "\n".join(lines)


def changes(before, after):
    """What got worse and what got better in one picture, beyond the tolerances."""
    worse, better = [], []
    for score, more_is_better, share, above, _ in SCORES:
        a, b = before.get(score), after.get(score)
        if a is None and b is None:
            continue
        said = f"{score} {number(None if a is None else float(a))} -> {number(None if b is None else float(b))}"
        if a is None or b is None:
            # A picture that is not fitted any more has no scores.
            (worse if b is None else better).append(said)
            continue
        gain = (float(b) - float(a)) * (1 if more_is_better else -1)
        tolerance = share * abs(float(a)) + above
        if gain < -tolerance:
            worse.append(said)
        elif gain > tolerance:
            better.append(said)
    return worse, better


def compare(before, after):
    """Prints the table and the pictures that changed; whether any got worse."""
    worse, better = [], []
    for name, old in before["sets"].items():
        new = after["sets"].get(name)
        if new is None:
            print(f"NOT COMPARED {name}: only in the first record")
            continue
        if before["pictures"].get(name) != after["pictures"].get(name) and before["quick"] == after["quick"]:
            print(f"NOT COMPARED {name}: the records are about different pictures (--work must be the same folder)")
            continue
        both = sorted(set(old) & set(new))
        if not before["quick"] and not after["quick"]:
            worse += [f"{name}/{picture}: not in the second record" for picture in sorted(set(old) - set(new))]
        rows = [row({k: r[k] for k in both}) for r in (old, new)]
        told = (f"{s} {number(rows[0].get(s))} -> {number(rows[1].get(s))}" for s in rows[0] | rows[1])
        print(f"{name} ({len(both)}): " + ", ".join(told))
        for picture in both:
            lost, won = changes(old[picture], new[picture])
            worse += [f"{name}/{picture}: {', '.join(lost)}"] * bool(lost)
            better += [f"{name}/{picture}: {', '.join(won)}"] * bool(won and not lost)
    for name in after["sets"].keys() - before["sets"].keys():
        print(f"NOT COMPARED {name}: only in the second record")
    for title, lines in (("BETTER", better), ("WORSE", worse)):
        print(f"\n{title}: {len(lines)} pictures")
        for line in lines:
            print("  " + line)
    return bool(worse)
