"""Scenes: what they hold and what they become."""

from __future__ import annotations

import copy
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dvp


def test_scenes_survive_texts_and_pickles(shipped: Path) -> None:
    scene = dvp.fit(shipped)
    assert dvp.Scene.from_json(scene.to_json()) == scene
    twin = pickle.loads(pickle.dumps(scene))
    assert twin == scene == copy.deepcopy(scene) and hash(twin) == hash(scene)
    assert twin.mae == scene.mae and twin.measures() == scene.measures()
    assert scene != dvp.generate()[0] and scene != 3
    assert json.loads(scene.to_json())["version"] == 3


def test_objects_are_measured(square: Any) -> None:
    scene = dvp.fit(square)
    measures = scene.measures(pixel_mm=0.5)
    assert measures["area_px2"] == pytest.approx([1024], rel=1e-3)
    assert measures["area_mm2"] == pytest.approx([256], rel=1e-3)
    assert measures["centroid_x_px"] == pytest.approx([32], abs=0.01)
    assert measures["color"] == ["#1e3cc8"]
    ((ring,),) = scene.outlines()
    assert ring.min() == pytest.approx(16, abs=0.02) and ring.max() == pytest.approx(48, abs=0.02)
    with pytest.raises(dvp.DvpError, match="above 0"):
        scene.measures(pixel_mm=0.0)


def test_tables_of_pyarrow(square: Any) -> None:
    pa = pytest.importorskip("pyarrow")
    table = dvp.table([dvp.fit(square), dvp.DvpError("no")], names=["a/b.png", "c.png"])
    assert table.num_rows == 2 and table.schema.field("object").type == pa.int64()
    assert table["picture"].to_pylist() == ["a/b.png", "c.png"] and table["stem"].to_pylist() == ["b", "c"]
    assert table["error"].to_pylist() == [None, "no"]


def test_colors_may_change_from_place_to_place() -> None:
    stops = [{"offset": 0, "color": [0.1, 0.2, 0.3]}, {"offset": 1, "color": [0.5, 0.4, 0.3]}]
    ramp = {"kind": "linear", "points": [[-0.2, 0], [0.2, 0]], "stops": stops}
    disk = {"kind": "circle", "radius": 0.2, "translation": [0.5, 0.5], "color": [0.3, 0.3, 0.3], "ramp": ramp}
    scene = {"version": 3, "width": 32, "height": 32, "background": [1, 1, 1], "objects": [disk]}
    (first,) = dvp.Scene.from_json(json.dumps(scene)).objects
    assert first.ramp is not None and first.ramp["kind"] == "linear" and len(first.ramp["stops"]) == 2
    assert first.color == pytest.approx((0.3, 0.3, 0.3))


def test_every_object_is_whole() -> None:
    picture = np.full((64, 64, 3), 255, np.uint8)
    picture[10:40, 10:40] = (200, 0, 0)
    picture[20:50, 20:50] = (0, 0, 200)
    scene = dvp.fit(picture)
    whole = scene.whole()
    assert whole.shape == (2, 64, 64) and whole.dtype == np.float32
    # The red square is whole though the blue one hides a quarter of it.
    assert whole.sum(axis=(1, 2)) == pytest.approx([900, 900], rel=0.01)
    labels = scene.labels()
    assert [(labels == k).sum() for k in (1, 2)] == [900 - 400, 900]


def test_pixels_that_refute_the_scene_belong_to_what_they_show() -> None:
    picture = np.full((64, 64, 3), 255, np.uint8)
    picture[10:40, 10:40] = 0
    scene = dvp.fit(picture)
    # Of this pixel beside the square the picture has more than half.
    picture[20, 40] = 100
    assert scene.labels()[20, 40] == 0
    labels = scene.labels(picture)
    assert labels[20, 40] == 1 and (labels == 1).sum() == 900 + 1
    with pytest.raises(dvp.DvpError, match="32 x 64 pixels for a scene of 64 x 64"):
        scene.labels(picture[:, :32])


def test_images_have_the_size_and_type_asked_for(square: Any) -> None:
    scene = dvp.fit(square)
    assert scene.render((128, 32)).shape == (32, 128, 3)
    assert scene.render(rgba=True).shape == (64, 64, 4)
    floats = scene.render(dtype=np.float32)
    assert floats.dtype == np.float32 and np.abs(floats - square / 255).max() < 0.005
    assert np.abs(scene.render().astype(int) - square).max() <= 1
    with pytest.raises(dvp.DvpError, match="dtype"):
        scene.render(dtype=np.int16)
    with pytest.raises(dvp.DvpError, match="size"):
        scene.render(5)  # type: ignore[arg-type]


def test_random_scenes_are_those_of_the_command(tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    from test_fit import command

    done = command("generate", "--count", "3", "--seed", "9", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    for k, scene in enumerate(dvp.generate(3, seed=9)):
        assert np.array_equal(np.asarray(image.open(tmp_path / f"{k:05}.png")), scene.render())
    assert all(len(s) == 2 for s in dvp.generate(5, visible=(2, 2)))
    assert dvp.generate(1, preset="multi-dsprites")[0].size == (64, 64)
    assert dvp.generate(0) == []


def test_scores_fall_with_errors() -> None:
    truth = dvp.generate(6, seed=21)
    images = [scene.render() for scene in truth]
    perfect = dvp.evaluate(truth, images, truth)
    found = dvp.evaluate([s for s in dvp.fit_many(images, bank="mdshr") if isinstance(s, dvp.Scene)], images, truth)
    wrong = dvp.evaluate(truth[::-1], images, truth)
    assert perfect["mae"] is not None and found["mae"] is not None and wrong["mae"] is not None
    assert perfect["mae"] < 0.002 and found["mae"] < 0.02 < wrong["mae"]
    assert perfect["ari"] == 1.0 and found["ari"] is not None and found["ari"] > 0.9
    by_labels = dvp.evaluate(truth, images, [scene.labels() for scene in truth])
    assert by_labels["ari"] is not None and by_labels["ari"] > 0.9
    assert dvp.evaluate(truth, images)["ari"] is None
    failed = dvp.evaluate(truth[:1], [np.zeros((4, 4, 3), np.uint8)])
    assert failed["n"] == 0 and "pixels" in failed["failed"][0]["error"]
