"""Whatever comes in, what comes out is a DvpError that says what was wrong, or a scene; never a panic."""

from __future__ import annotations

import pickle
import random
from typing import Any

import numpy as np
import pytest

import dvp

PICTURES: list[tuple[Any, str]] = [
    (np.full((8, 8, 3), np.nan), "nan"),
    (np.full((8, 8, 3), np.inf), "inf"),
    (np.full((8, 8, 3), 255.0), "255.0; floats must lie from 0 to 1"),
    (np.full((8, 8, 3), -0.5, np.float32), "-0.5"),
    (np.zeros((0, 0, 3), np.uint8), "0 x 0 pixels"),
    (np.zeros((0, 5), np.float32), "0 x 5 pixels"),
    (np.zeros((8, 8, 2), np.uint8), "height x width"),
    (np.zeros((8, 8, 5), np.uint8), "height x width"),
    (np.zeros((2, 8, 8, 3), np.uint8), "height x width"),
    (np.zeros(8, np.uint8), "height x width"),
    (np.zeros((8, 8, 3), np.int64), "int64"),
    (np.zeros((8, 8, 3), np.uint16), "array / 65535"),
    (np.zeros((8, 8, 3), bool), "bool"),
    (np.zeros((8, 8, 3), complex), "complex128"),
    (np.zeros((8, 8), object), "object"),
    (np.zeros((8, 8), "U3"), "U3"),
    ([[1, 2], [3, 4]], "int"),
    ([[1], [2, 3]], "no array"),
    ([], "height x width"),
    (None, "NoneType"),
    (3, "int"),
    (True, "bool"),
    ({"a": 1}, "dict"),
    (object(), "height x width"),
    (b"", "bytes: "),
    (b"\x00" * 100, "bytes: "),
    (b"\x89PNG\r\n\x1a\n" + b"\xff" * 64, "bytes: "),
    ("", "cannot be read"),
    (".", "cannot be read|not a readable image|directory"),
    ("no/such/file.png", "no/such/file.png: cannot be read"),
]


@pytest.mark.parametrize("picture, words", PICTURES, ids=[str(k) for k in range(len(PICTURES))])
def test_what_is_no_picture_is_refused(picture: Any, words: str) -> None:
    with pytest.raises(dvp.DvpError, match=words):
        dvp.fit(picture)
    (result,) = dvp.fit_many([picture])
    assert isinstance(result, dvp.DvpError)


def test_a_name_with_a_zero_byte_is_refused() -> None:
    with pytest.raises(ValueError):
        dvp.fit("a\0b.png")


def test_what_is_huge_is_refused() -> None:
    huge = np.broadcast_to(np.zeros((1, 1, 1), np.uint8), (20_000, 20_000, 3))
    with pytest.raises(dvp.DvpError, match="max_pixels"):
        dvp.fit(huge[:5000, :5000], max_pixels=1_000_000)
    scene = dvp.generate()[0]
    with pytest.raises(dvp.DvpError, match="must be 1 to"):
        scene.render((10**6, 10**6))
    with pytest.raises(dvp.DvpError):
        scene.render((0, 5))
    with pytest.raises(dvp.DvpError):
        scene.render((-1, 5))
    text = scene.to_json().replace('"width":128,"height":128', '"width":1000000,"height":1000000')
    with pytest.raises(dvp.DvpError, match="above the limit"):
        dvp.Scene.from_json(text)


@pytest.mark.parametrize("shape", [(1, 1), (1, 300), (300, 1), (2, 2), (3, 2)])
def test_small_and_thin_pictures_are_fitted(shape: tuple[int, int]) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (*shape, 3), dtype=np.uint8)
    assert dvp.fit(noise).size == (shape[1], shape[0])


def test_bytes_that_rot_never_panic(png: bytes) -> None:
    rng = random.Random(4711)
    outcomes = set()
    for _ in range(150):
        rotten = bytearray(png)
        for _ in range(rng.randint(1, 8)):
            rotten[rng.randrange(len(rotten))] = rng.randrange(256)
        outcomes.add(type(dvp.fit_many([bytes(rotten[: rng.randint(0, len(rotten))])])[0]).__name__)
    assert "DvpError" in outcomes and outcomes <= {"DvpError", "Scene"}


OPTIONS: list[tuple[dict[str, Any], str]] = [
    ({"method": "magic"}, "segment, opt-iter"),
    ({"compositing": "under"}, "over, blend"),
    ({"bank": "no/bank.json"}, "no/bank.json"),
    ({"bank": {}}, "at least one shape"),
    ({"bank": {"a": [[1, 2, 3]]}}, "rows"),
    ({"bank": {"a": [[1, 2, 3, np.nan]]}}, "finite"),
    ({"bank": 3}, "bank cannot be of type int"),
    ({"bank": "{"}, "bank"),
    ({"method": "opt-p"}, "--start"),
    ({"start": "net", "bank": "mdshr"}, "leave bank away"),
    ({"model": "x"}, "model goes with"),
    ({"start": "net", "model": "no/model"}, "no/model"),
    ({"max_objects": -1}, "max_objects=-1"),
    ({"seed": 2**70}, "seed"),
]


@pytest.mark.parametrize("options, words", OPTIONS, ids=[str(k) for k in range(len(OPTIONS))])
def test_bad_options_are_refused(square: Any, options: dict[str, Any], words: str) -> None:
    with pytest.raises(dvp.DvpError, match=words):
        dvp.fit(square, **options)


def test_unknown_options_are_refused(square: Any) -> None:
    with pytest.raises(TypeError, match="colour"):
        dvp.fit(square, colour="red")


TEXTS = ["", "{", "[]", "null", '{"version": 9}', '{"version": 3}', "\0", '{"version":3,"background":[2,0,0],"objects":[]}']


@pytest.mark.parametrize("text", TEXTS)
def test_texts_that_are_no_scene_are_refused(text: str) -> None:
    with pytest.raises(dvp.DvpError, match="scene"):
        dvp.Scene.from_json(text)


def test_a_scene_without_a_size_is_refused() -> None:
    with pytest.raises(dvp.DvpError, match="width is missing"):
        dvp.Scene.from_json('{"version":3,"background":[1,1,1],"objects":[]}')


def test_contours_that_are_none_are_refused() -> None:
    for contour in ([], [[0, 0], [1, 1]], [[0, 0], [1, np.nan], [1, 1]], [[1, 2, 3]], "abc", None, 3, [[0, 0]] * 9):
        with pytest.raises(dvp.DvpError):
            dvp.efd([contour])
    with pytest.raises(dvp.DvpError, match="harmonics"):
        dvp.efd([[0, 0], [1, 0], [0, 1]], 0)
    with pytest.raises(dvp.DvpError, match="contour 1"):
        dvp.efd([[[0, 0], [1, 0], [0, 1]], [[0, 0]]])
    with pytest.raises(dvp.DvpError, match="overflow"):
        dvp.efd([[0, 0], [1e308, 0], [0, 1e308], [-1e308, -1e308]])


def test_bad_settings_of_random_scenes_are_refused() -> None:
    for settings in ({"preset": "x"}, {"scale": (0.3, 0.1)}, {"visible": (3, 1)}, {"color": (0, 2)}, {"size": (0, 4)},
                     {"scale": (np.nan, 1)}, {"bank": None}, {"visible": "ab"}, {"count": -1}, {"compositing": "x"}):  # fmt: skip
        with pytest.raises(dvp.DvpError):
            dvp.generate(**settings)


def test_exceptions_are_value_errors_and_can_be_sent() -> None:
    assert issubclass(dvp.DvpError, ValueError) and dvp.DvpError.__module__ == "dvp"
    error = pickle.loads(pickle.dumps(dvp.DvpError("a text")))
    assert type(error) is dvp.DvpError and str(error) == "a text"
