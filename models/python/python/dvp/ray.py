"""Pictures to objects on a Ray cluster.

Two ways. In a pipeline of Ray Data, :class:`Fit` goes to ``map_batches``: actors that keep bank and memory warm. For a folder larger than
one machine, :func:`fit_to_parquet` writes a file per shard, goes on where an earlier run stopped, and neither loses nor doubles a picture
when a worker dies.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import ray

from ._batches import BatchFitter
from ._dvp import DvpError

__all__ = ["Fit", "fit_to_parquet"]

#: Paths of a shard's pictures, the file of its objects, the options as JSON.
_Work = tuple[list[str], str, str]


class Fit(BatchFitter):
    """For ``dataset.map_batches(dvp.ray.Fit, batch_format="pyarrow", concurrency=ACTORS)``; options by ``fn_constructor_kwargs``.

    An actor keeps its core as long as the pipeline lasts: give it fewer actors than the cluster has cores, or what reads the pictures
    waits for a core for ever.

    The data set holds a column of pictures (``bytes`` and ``path``, as ``ray.data.read_binary_files(folder, include_paths=True)`` gives
    them), or with ``batch_format="numpy"`` arrays. Out comes a row per object, and one with ``error`` for each picture that failed.
    """


@functools.lru_cache(maxsize=4)
def _fitter(options: str) -> BatchFitter:
    """Kept in a worker from shard to shard."""
    return BatchFitter("path", "path", **json.loads(options))


def _write_shard(paths: list[str], target: str, options: str) -> int:
    import pyarrow as pa
    import pyarrow.parquet as parquet

    objects = _fitter(options)(pa.table({"path": pa.array(paths, pa.string())}))
    # Under the name of the shard stands nothing, or all of it.
    part = f"{target}.{os.getpid()}.part"
    parquet.write_table(objects, part)
    os.replace(part, target)
    return int(objects.num_rows)


class _ShardWriter:
    """An actor that writes shards, with bank and memory of its own."""

    def write(self, paths: list[str], target: str, options: str) -> int:
        return _write_shard(paths, target, options)


def fit_to_parquet(
    pictures: Sequence[str | os.PathLike[str]],
    out: str | os.PathLike[str],
    *,
    shard: int = 500,
    actors: int | None = None,
    **options: Any,
) -> dict[str, int]:
    """Fits the files ``pictures``, ``shard`` of them at a time on a core of the cluster, and writes the objects of each shard to
    ``out/shard-NNNNN.parquet``: a row per object, and one with ``error`` for each picture that failed.

    Shards are tasks of the cluster, on all its cores and on those that join while it works; with ``actors``, so many actors of a core
    each do them, which leaves the other cores to others.

    All machines must see the files and the folder. Run again with the same pictures and options it goes on: shards that are there are
    not fitted again. A shard whose worker or actor dies is done again, whole. Returns how many shards there are, how many of them this run
    made, and the rows that it wrote. ``options`` are those of :class:`dvp.Fitter`, of values that JSON can hold.

    Raises :class:`dvp.DvpError` if the folder holds the shards of other pictures or options.
    """
    if shard < 1:
        raise DvpError(f"shard={shard}: must be at least 1")
    if actors is not None and actors < 1:
        raise DvpError(f"actors={actors}: must be at least 1, or None for tasks on all cores")
    paths = [os.fspath(picture) for picture in pictures]
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    try:
        text = json.dumps(options, sort_keys=True)
    except TypeError as error:
        raise DvpError(f"options {options}: {error}; give a bank by name or as a file") from error
    work = hashlib.sha256(json.dumps([paths, shard, text]).encode()).hexdigest()
    plan = folder / "plan.json"
    if plan.exists():
        if json.loads(plan.read_text())["work"] != work:
            raise DvpError(f"{folder}: holds the shards of other pictures or options; choose another folder")
    else:
        plan.write_text(json.dumps({"work": work, "pictures": len(paths), "shard": shard, "options": options}))
    shards = [paths[start : start + shard] for start in range(0, len(paths), shard)]
    targets = [folder / f"shard-{k:05}.parquet" for k in range(len(shards))]
    missing = [k for k, target in enumerate(targets) if not target.exists()]
    work_of = [(shards[k], str(targets[k].absolute()), text) for k in missing]
    rows = sum(_by_tasks(work_of) if actors is None else _by_actors(work_of, actors))
    return {"shards": len(shards), "made": len(missing), "rows": rows}


# A process that dies is no fault of the shard: it is tried again for ever. What is wrong with pictures is in the rows.


def _by_tasks(work: list[_Work]) -> Iterator[int]:
    remote = ray.remote(num_cpus=1, max_retries=-1)(_write_shard)
    waiting = [remote.remote(*own) for own in work]
    while waiting:
        done, waiting = ray.wait(waiting, num_returns=1)
        yield from ray.get(done)


def _by_actors(work: list[_Work], count: int) -> Iterator[int]:
    remote: Any = ray.remote(num_cpus=1, max_restarts=-1, max_task_retries=-1)(_ShardWriter)
    actors = [remote.remote() for _ in range(min(count, len(work)))]
    try:
        pool = ray.util.ActorPool(actors)
        yield from pool.map_unordered(lambda actor, own: actor.write.remote(*own), work) if work else ()
    finally:
        # Their cores are wanted by what comes next, which may be before anybody collects garbage.
        for actor in actors:
            ray.kill(actor)
