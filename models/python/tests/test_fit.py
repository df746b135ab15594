"""What is found in pictures, however they are handed over."""

from __future__ import annotations

import io
import os
import pickle
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dvp

Image = pytest.importorskip("PIL.Image")


def test_every_way_in_gives_the_same_scene(square: Any, png: bytes, tmp_path: Path) -> None:
    path = tmp_path / "square.png"
    path.write_bytes(png)
    expected = dvp.fit(square)
    assert [o.kind for o in expected.objects] == ["rectangle"]
    gray = np.full((64, 64), 255, np.uint8)
    gray[16:48, 16:48] = 40
    assert dvp.fit(gray) == dvp.fit(np.stack([gray] * 3, axis=2))
    opaque = np.dstack([square, np.full((64, 64), 255, np.uint8)])
    ways = [str(path), path, png, bytearray(png), memoryview(png), Image.open(path), opaque, np.asfortranarray(square)]
    ways.append(np.repeat(square, 2, axis=1)[:, ::2])
    for way in ways:
        assert dvp.fit(way) == expected, type(way)


def test_floats_are_taken_as_they_are(square: Any) -> None:
    for dtype in (np.float16, np.float32, np.float64):
        scene = dvp.fit((square / 255).astype(dtype))
        assert [o.kind for o in scene.objects] == ["rectangle"]
        assert scene.objects[0].color == pytest.approx((30 / 255, 60 / 255, 200 / 255), abs=1e-3)


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "dvp", *arguments], capture_output=True, text=True)


@pytest.mark.parametrize("options", [{}, {"bank": "mdshr"}, {"max_objects": 2}, {"compositing": "blend"}])
def test_the_command_writes_the_same_bytes(shipped: Path, tmp_path: Path, options: dict[str, Any]) -> None:
    scene = dvp.fit(shipped, **options)
    flags = [text for name, value in options.items() for text in (f"--{name.replace('_', '-')}", str(value))]
    done = command("fit", str(shipped), "--out", str(tmp_path), "--labels", "--table", str(tmp_path / "t.csv"), *flags)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "shapes.json").read_text() == scene.to_json() + "\n"
    assert (tmp_path / "shapes.svg").read_text() == scene.to_svg()
    assert np.array_equal(np.asarray(Image.open(tmp_path / "shapes.png")), scene.render())
    assert np.array_equal(np.asarray(Image.open(tmp_path / "shapes.labels.png")), scene.labels(shipped))
    header, *rows = (tmp_path / "t.csv").read_text().splitlines()
    columns = scene.measures(name=str(shipped))
    assert header.split(",") == list(columns)
    assert len(rows) == len(scene) == len(columns["object"])
    area = [float(row.split(",")[header.split(",").index("area_px2")]) for row in rows]
    assert columns["area_px2"] == area


def test_a_jpeg_is_known_as_one(shipped: Path, tmp_path: Path) -> None:
    path = tmp_path / "shapes.jpg"
    Image.open(shipped).convert("RGB").save(path, quality=60)
    expected = dvp.fit(path)
    assert dvp.fit(path.read_bytes()) == expected
    pixels = np.asarray(Image.open(path))
    assert dvp.fit(pixels, coded=True).objects == dvp.fit(Image.open(path)).objects


def test_masks_become_outlines(square: Any) -> None:
    masks = np.zeros((64, 64), np.int32)
    masks[16:48, 16:48] = 7
    scene = dvp.fit(square, masks=masks)
    assert [o.number for o in scene.objects] == [7]
    assert scene.objects[0].color == pytest.approx((30 / 255, 60 / 255, 200 / 255), abs=1e-6)
    assert np.array_equal(np.unique(scene.labels()), [0, 7])
    assert len(dvp.fit(masks=masks)) == 1
    with pytest.raises(dvp.DvpError, match="64 x 64 pixels, its picture has 10 x 10"):
        dvp.fit(square[:10, :10], masks=masks)
    with pytest.raises(dvp.DvpError, match="bank: of no use with masks"):
        dvp.fit(square, masks=masks, bank="mdshr")


def test_transparent_pictures_stay_transparent(square: Any) -> None:
    alpha = np.zeros((64, 64, 1), np.uint8)
    alpha[16:48, 16:48] = 255
    scene = dvp.fit(np.concatenate([square, alpha], axis=2))
    assert scene.transparent and scene.background is None
    image = scene.render()
    assert image.shape == (64, 64, 4)
    assert image[0, 0, 3] == 0 and tuple(image[30, 30]) == (30, 60, 200, 255)


def test_many_keep_their_order_and_tell_errors_as_values(square: Any, tmp_path: Path) -> None:
    bad = tmp_path / "bad.png"
    bad.write_bytes(b"\x89PNG\r\n\x1a\n nothing")
    pictures = [square, bad, square[::-1], np.full((4, 4, 3), np.nan), "missing.png", np.zeros((0, 3, 3), np.uint8)]
    for threads in (1, 2):
        results = dvp.fit_many(pictures, threads=threads)
        kinds = [type(result).__name__ for result in results]
        assert kinds == ["Scene", "DvpError", "Scene", "DvpError", "DvpError", "DvpError"]
        assert str(bad) in str(results[1]) and "missing.png" in str(results[4])
        assert results[0] == dvp.fit(square)
    columns = dvp.measures(results, names=list("abcdef"))
    assert columns["picture"] == list("abcdef")
    assert [error is None for error in columns["error"]] == [True, False, True, False, False, False]
    assert dvp.fit_many([]) == []


def test_the_lock_is_released(shipped: Path) -> None:
    turns = [0]
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            turns[0] += 1
            done.wait(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    before = turns[0]
    dvp.fit_many([str(shipped)] * 20, threads=1)
    during = turns[0] - before
    done.set()
    counter.join()
    # A thread that waits for the lock would count not even once while a native call runs.
    assert during >= 5


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_an_interrupt_stops_a_long_run(shipped: Path) -> None:
    # Twenty minutes of work on one thread, if nothing stopped it.
    # What runs in the background of a shell has interrupts switched off, and hands that on.
    listen = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    code = f"{listen}; import dvp; print('on', flush=True); dvp.fit_many([{str(shipped)!r}] * 50000, threads=1)"
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "on\n"
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(timeout=1)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode != 0 and "KeyboardInterrupt" in errors


def test_a_fitter_is_kept_and_sent(square: Any) -> None:
    fitter = pickle.loads(pickle.dumps(dvp.Fitter(bank="mdshr")))
    assert fitter.fit(square) == dvp.fit(square, bank="mdshr")
    results: list[Any] = []
    threads = [threading.Thread(target=lambda: results.append(fitter.fit(square))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4 and all(result == results[0] for result in results)


def test_a_bank_of_ones_own() -> None:
    triangle = dvp.efd([[0, 0], [4, 0], [0, 3]], 12)
    bank = {"triangle": triangle, "disk": [[1, 0, 0, 1]]}
    truth = dvp.generate(3, bank=bank, seed=5, visible=(1, 1), size=(96, 96))
    found = dvp.fit(truth[0].render(), bank=bank)
    assert {name for scene in truth for name in scene.measures()["prototype"]} <= {"triangle", "disk"}
    assert found.measures()["prototype"] == truth[0].measures()["prototype"]


def test_what_the_network_sees() -> None:
    truth = dvp.generate(1, seed=11)[0]
    scene = dvp.fit(truth.render(), start="net")
    assert len(scene) == len(truth) and scene.mae is not None and scene.mae < 0.02


def test_the_modules_and_the_script_run_the_command(tmp_path: Path) -> None:
    assert command("--version").stdout.strip() == f"dvp {dvp.__version__}"
    assert command("fit").returncode == 2
    failed = command("fit", "missing.png", "--out", str(tmp_path))
    assert failed.returncode == 1 and "missing.png" in failed.stderr
    script = Path(sys.executable).with_name("dvp")
    if not os.access(script, os.X_OK):
        pytest.skip("the package was not installed by pip: no script beside this python")
    assert subprocess.run([script, "--version"], capture_output=True, text=True).stdout == f"dvp {dvp.__version__}\n"


def test_palettes_and_sixteen_bits_of_pil(square: Any) -> None:
    palette = Image.fromarray(square).quantize(4)
    assert [o.kind for o in dvp.fit(palette).objects] == ["rectangle"]
    gray = np.full((64, 64), 60000, np.uint16)
    gray[16:48, 16:48] = 9000
    buffer = io.BytesIO()
    Image.fromarray(gray).save(buffer, "PNG")
    from_pil = dvp.fit(Image.open(buffer))
    assert from_pil.objects == dvp.fit(buffer.getvalue()).objects
