"""Writes scene_loss.json: three of the 64 pairs of scenes that the reference implementation was run on.

Needs the folder `shared` beside the repository: python3 make_scene_loss.py
"""

import json
import pathlib

HERE = pathlib.Path(__file__).parent
SOURCE = HERE / "../../../shared/fixtures/d_scene_loss.json"
# As many true objects as slots; spare slots; unrelated scenes. All with objects of different symmetry.
CHOSEN = [2, 35, 48]


def short(value):
    """The fewest digits that give the single-precision number back; hidden true objects keep their place only."""
    if isinstance(value, float):
        return float(f"{value:.9g}")
    if isinstance(value, list):
        return [short(v) for v in value]
    if isinstance(value, dict):
        return {k: short(v) for k, v in value.items()}
    return value


pairs = json.loads(SOURCE.read_text())["pairs"]
chosen = [pairs[i] for i in CHOSEN]
for pair in chosen:
    for scene in (pair["true"], pair["pred"]):
        for item in scene["objects"]:
            if item["confidence"] == 0.0:
                item["efd"] = item["efd"][:1]
(HERE / "scene_loss.json").write_text(json.dumps({"pairs": short(chosen)}, separators=(",", ":")) + "\n")
