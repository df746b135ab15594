"""Ray: rows are objects, a killed worker or actor loses and doubles nothing, a second run fits nothing again."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
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


def kill_a_process(stop: threading.Event, killed: list[str], title: str, is_time: Callable[[int], bool]) -> None:
    """Kills a process that fits, by what Ray calls it while it works, once it is time after so many sights of such processes."""
    import psutil

    seen = 0
    while not stop.is_set() and not killed:
        for process in psutil.Process().children(recursive=True):
            try:
                own = " ".join(process.cmdline())
            except psutil.Error:
                continue
            if own.startswith(title):
                seen += 1
                if is_time(seen):
                    os.kill(process.pid, signal.SIGKILL)
                    killed.append(own)
                    break
        time.sleep(0.002)


def rows_of(out: Path) -> list[tuple[str, int | None]]:
    table = parquet.read_table([str(path) for path in sorted(out.glob("*.parquet"))])
    return list(zip(table["picture"].to_pylist(), table["object"].to_pylist()))


@contextlib.contextmanager
def one_is_killed(title: str, is_time: Callable[[int], bool]) -> Iterator[None]:
    """While it lasts, one process of that title is killed."""
    pytest.importorskip("psutil")
    stop, killed = threading.Event(), list[str]()
    killer = threading.Thread(target=kill_a_process, args=(stop, killed, title, is_time))
    killer.start()
    try:
        yield
    finally:
        stop.set()
        killer.join()
    assert killed, "nothing was killed, so that this test has shown nothing"
    print(f"killed: {killed[0]}")


@pytest.mark.parametrize(("actors", "title"), [(None, "ray::_write_shard"), (2, "ray::_ShardWriter.write")])
def test_a_killed_process_loses_and_doubles_nothing(
    actors: int | None, title: str, cluster: None, pictures: list[str], tmp_path: Path
) -> None:
    import dvp.ray

    out = tmp_path / "objects"
    out.mkdir()
    # Once some shards are there.
    with one_is_killed(title, lambda _: len(list(out.glob("*.parquet"))) >= 2):
        start = time.perf_counter()
        done = dvp.ray.fit_to_parquet(pictures, out, shard=max(10, COUNT // 40), actors=actors, bank="mdshr")
        seconds = time.perf_counter() - start
    start = time.perf_counter()
    expected = dvp.measures(dvp.fit_many(pictures, bank="mdshr", threads=2), names=pictures)
    alone = time.perf_counter() - start
    how = "tasks" if actors is None else f"{actors} actors"
    print(f"{COUNT} pictures: {seconds:.1f} s by {how} of Ray, one killed; {alone:.1f} s by fit_many on 2 threads")
    assert rows_of(out) == list(zip(expected["picture"], expected["object"]))
    assert done["rows"] == len(expected["picture"]) and done["made"] == done["shards"]
    failed = [name for name, error in zip(expected["picture"], expected["error"]) if error is not None]
    assert failed == [pictures[-1]]
    # A second run fits nothing again; without one shard it fits that one.
    before = {path: path.stat().st_mtime_ns for path in out.glob("*.parquet")}
    again = dvp.ray.fit_to_parquet(pictures, out, shard=max(10, COUNT // 40), actors=actors, bank="mdshr")
    assert {path: path.stat().st_mtime_ns for path in out.glob("*.parquet")} == before
    assert again == {"shards": done["shards"], "made": 0, "rows": 0}
    (out / "shard-00001.parquet").unlink()
    again = dvp.ray.fit_to_parquet(pictures, out, shard=max(10, COUNT // 40), actors=actors, bank="mdshr")
    assert again["made"] == 1
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


def test_a_killed_actor_of_a_pipeline_loses_and_doubles_nothing(cluster: None, pictures: list[str], tmp_path: Path) -> None:
    pytest.importorskip("pandas", reason="Ray Data needs pandas")
    import dvp.ray

    out = tmp_path / "objects"
    out.mkdir()
    # Blocks of few pictures: some are done when the actor dies, some are not begun.
    frame = ray.data.from_items([{"path": path} for path in pictures], override_num_blocks=40)
    fitted = frame.map_batches(
        dvp.ray.Fit,
        batch_format="pyarrow",
        batch_size=max(10, COUNT // 40),
        concurrency=2,
        fn_constructor_kwargs=dict(column="path", bank="mdshr"),
    )
    with one_is_killed("ray::MapWorker(MapBatches(Fit)).submit", lambda seen: seen >= 20):
        fitted.write_parquet(str(out))
    expected = dvp.measures(dvp.fit_many(pictures, bank="mdshr", threads=2), names=pictures)
    assert sorted(rows_of(out), key=str) == sorted(zip(expected["picture"], expected["object"]), key=str)


def test_batches_of_arrays() -> None:
    from dvp._batches import BatchFitter

    images = np.stack([scene.render() for scene in dvp.generate(3, seed=2)])
    table = BatchFitter("image", None, bank="mdshr")({"image": images})
    assert table.num_rows == sum(len(s) for s in dvp.fit_many(images, bank="mdshr") if isinstance(s, dvp.Scene))
    with pytest.raises(dvp.DvpError, match="no column 'bytes'; it has image"):
        BatchFitter()({"image": images})
