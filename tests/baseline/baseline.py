#!/usr/bin/env python3
"""What a program makes of every picture of all sets, recorded, and two records held against each other.

    baseline.py record OUT.json --dvp EXE [--sets val,fresh,pictures,holes,circles,charts,real,spoiled,sprites] [--quick]
                [--seed N --count N]                   # other generated scenes, to look at
    baseline.py compare BEFORE.json AFTER.json     # exit code 1 if a picture got worse
    baseline.py show RECORD.json                   # tables of means, as markdown

| set | pictures | truth |
|---|---|---|
| val | the reference's 256 validation images of MDS-HR (../shared/mdshr), 32 of them in float, with and without its shapes | scenes |
| fresh | `dvp generate`: MDS-HR and the like of Multi-dSprites, seeds of sets.py; clean, noise 0.02 and 0.05, JPEG 80 | scenes |
| pictures | the suite tests/pictures, drawn by the example `any_picture` | label maps, scenes |
| holes | ../shared/holes from number 20 on (the first were looked at); connected components of equal color beside them | labels, whole shapes |
| circles | ../shared/circles | numbers of the circles |
| charts | charts.py, 128, 256 and 512 px | marks, SVG |
| real | ../shared/real at 128, 256, 512 px and as 400 px JPEG, peers at 256 px | SVG |
| spoiled | every 8th of `real` at 256 px with noise, blur, scaling, sharpening, or from coders of photographs (spoiled.py) | the picture before |
| sprites | sprites.py, as drawn, 4 and 8 times enlarged | their squares |

**Nobody debugs on `fresh`, `holes`, `circles`, `charts`, `real`, `spoiled` and `sprites`**: who looks at their pictures while changing the fit makes the
figures worthless. What is missing is skipped, which is said and recorded.

Pictures are made once and stay in --work (target/baseline), so that two records are about the same pictures; compare checks it. One
record at a time in such a folder.
Scores: right (number of objects or marks), ari and ari_objects (adjusted Rand index; of the pixels that truth gives to objects),
whole_iou, mae (against the clean picture), bits, ms (processor time of the fit, one thread; of the whole program for `real`), bad,
dE, dist, missed, numbers (as real.py), destroyed and half_missed (charts.py), center, radius, axes (px), z_* (errors in stated standard
deviations; tables show their root mean square), doubted (whether the fit doubts something). Tolerances: compare.py.

Makes an environment of its own in --work on first use (numpy, pillow, scikit-image, matplotlib).
"""

import argparse
import hashlib
import json
import os
import pathlib
import platform
import subprocess
import sys

from packages import run_with_packages

HERE = pathlib.Path(__file__).resolve().parent


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    record = commands.add_parser("record")
    record.add_argument("out", type=pathlib.Path)
    record.add_argument("--dvp", type=pathlib.Path, default=HERE / "../../target/release/dvp")
    record.add_argument("--sets", help="of those above, separated by commas")
    record.add_argument("--quick", action="store_true", help="a few pictures of each set")
    record.add_argument("--seed", type=int, help="of the generated scenes; another than the reported one, to change the fit by")
    record.add_argument("--count", type=int, help="of the generated scenes per preset")
    record.add_argument("--work", type=pathlib.Path, default=HERE / "../../target/baseline")
    record.add_argument("--shared", type=pathlib.Path, default=HERE / "../../../shared")
    compare = commands.add_parser("compare")
    compare.add_argument("before", type=pathlib.Path)
    compare.add_argument("after", type=pathlib.Path)
    show = commands.add_parser("show")
    show.add_argument("record", type=pathlib.Path)
    return parser.parse_args()


def record(a):
    work = a.work.resolve()
    code = run_with_packages(work)
    if code is not None:
        return code
    import sets
    wanted = a.sets.split(",") if a.sets else list(sets.ALL)
    unknown = [name for name in wanted if name not in sets.ALL]
    if unknown:
        sys.exit(f"no set {', '.join(unknown)}; there are {', '.join(sets.ALL)}")
    dvp = a.dvp.resolve()
    if not dvp.is_file():
        sys.exit(f"{dvp} is not there: build it with cargo build --release -p dvp, or name another with --dvp")
    place = sets.Place(str(dvp), work, a.shared.resolve(), a.quick, a.seed or sets.FRESH_SEED, a.count or sets.FRESH_COUNT)
    found = {}
    for name in wanted:
        for title, pictures in sets.ALL[name](place):
            found[title] = pictures
    version = subprocess.run([dvp, "--version"], capture_output=True, text=True).stdout.strip()
    a.out.write_text(json.dumps(dict(
        program=dict(version=version, sha256=hashlib.sha256(dvp.read_bytes()).hexdigest()[:16]),
        machine=f"{platform.machine()}, {os.cpu_count()} processors", quick=a.quick, skipped=place.skipped,
        pictures=place.hashes, sets=found), indent=0) + "\n")
    return 0


def main():
    a = arguments()
    if a.command == "record":
        return record(a)
    from compare import compare, show
    load = lambda path: json.loads(path.read_text())
    if a.command == "show":
        print(show(load(a.record)))
        return 0
    return int(compare(load(a.before), load(a.after)))


if __name__ == "__main__":
    sys.exit(main())
