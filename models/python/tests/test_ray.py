"""Ray: rows are objects, a killed worker loses and doubles nothing, a second run fits nothing again."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dvp

ray = pytest.importorskip("ray")
parquet = pytest.importorskip("pyarrow.parquet")
Image = pytest.importorskip("PIL.Image")

#: The full test has 10,000: DVP_RAY_PICTURES=10000.
COUNT = int(os.environ.get("DVP_RAY_PICTURES", "400"))


@pytest.fixture(scope="module")
def cluster() -> Iterator[None]:
    """A real cluster of processes on this machine."""
    ray.init(num_cpus=2, include_dashboard=False, logging_level="ERROR", log_to_driver=False)
    yield
    ray.shutdown()


@pytest.fixture(scope="module")
def pictures(tmp_path_factory: Any) -> list[str]:
    """Generated pictures, and one file that is none."""
    folder = tmp_path_factory.mktemp("pictures")
    paths = []
    for k, scene in enumerate(dvp.generate(COUNT - 1, seed=31, size=(64, 64))):
        paths.append(str(folder / f"{k:05}.png"))
        Image.fromarray(scene.render()).save(paths[-1])
    paths.append(str(folder / "broken.png"))
    Path(paths[-1]).write_bytes(b"no picture")
    return paths


def kill_a_worker(stop: threading.Event, killed: list[int], out: Path) -> None:
    """Kills a process that fits, once some shards are there."""
    import psutil

    while not stop.is_set() and not killed:
        if len(list(out.glob("*.parquet"))) >= 2:
            for process in psutil.Process().children(recursive=True):
                if "_write_shard" in " ".join(process.cmdline()):
                    os.kill(process.pid, signal.SIGKILL)
                    killed.append(process.pid)
                    break
        time.sleep(0.005)


def rows_of(out: Path) -> list[tuple[str, int | None]]:
    table = parquet.read_table([str(path) for path in sorted(out.glob("*.parquet"))])
    return list(zip(table["picture"].to_pylist(), table["object"].to_pylist()))


def test_a_killed_worker_loses_and_doubles_nothing(cluster: None, pictures: list[str], tmp_path: Path) -> None:
    pytest.importorskip("psutil")
    import dvp.ray

    out = tmp_path / "objects"
    out.mkdir()
    stop, killed = threading.Event(), list[int]()
    killer = threading.Thread(target=kill_a_worker, args=(stop, killed, out))
    killer.start()
    start = time.perf_counter()
    done = dvp.ray.fit_to_parquet(pictures, out, shard=max(10, COUNT // 40), bank="mdshr")
    seconds = time.perf_counter() - start
    stop.set()
    killer.join()
    assert killed, "no worker was killed, so that this test has shown nothing"
    start = time.perf_counter()
    expected = dvp.measures(dvp.fit_many(pictures, bank="mdshr", threads=2), names=pictures)
    alone = time.perf_counter() - start
    print(f"{COUNT} pictures: {seconds:.1f} s on 2 workers of Ray, one killed; {alone:.1f} s by fit_many on 2 threads")
    assert rows_of(out) == list(zip(expected["picture"], expected["object"]))
    assert done["rows"] == len(expected["picture"]) and done["made"] == done["shards"]
    failed = [name for name, error in zip(expected["picture"], expected["error"]) if error is not None]
    assert failed == [pictures[-1]]
    # A second run fits nothing again; without one shard it fits that one.
    again = dvp.ray.fit_to_parquet(pictures, out, shard=max(10, COUNT // 40), bank="mdshr")
    assert again == {"shards": done["shards"], "made": 0, "rows": 0}
    (out / "shard-00001.parquet").unlink()
    assert dvp.ray.fit_to_parquet(pictures, out, shard=max(10, COUNT // 40), bank="mdshr")["made"] == 1
    assert rows_of(out) == list(zip(expected["picture"], expected["object"]))
    with pytest.raises(dvp.DvpError, match="other pictures or options"):
        dvp.ray.fit_to_parquet(pictures, out)


def test_pipelines_of_ray_data(cluster: None, pictures: list[str]) -> None:
    pytest.importorskip("pandas", reason="Ray Data needs pandas")
    import dvp.ray

    some = pictures[-20:]
    frame = ray.data.from_items([{"bytes": Path(path).read_bytes(), "path": path} for path in some])
    found = frame.map_batches(
        dvp.ray.Fit, batch_format="pyarrow", batch_size=5, concurrency=2, fn_constructor_kwargs=dict(bank="mdshr")
    )
    rows = sorted((row["picture"], row["object"] or 0) for row in found.take_all())
    expected = dvp.measures(dvp.fit_many(some, bank="mdshr"), names=some)
    assert rows == sorted((name, number or 0) for name, number in zip(expected["picture"], expected["object"]))


def test_batches_of_arrays() -> None:
    from dvp._batches import BatchFitter

    images = np.stack([scene.render() for scene in dvp.generate(3, seed=2)])
    table = BatchFitter("image", None, bank="mdshr")({"image": images})
    assert table.num_rows == sum(len(s) for s in dvp.fit_many(images, bank="mdshr") if isinstance(s, dvp.Scene))
    with pytest.raises(dvp.DvpError, match="no column 'bytes'; it has image"):
        BatchFitter()({"image": images})
