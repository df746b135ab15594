"""Batches of a table of pictures to batches of a table of objects: what :mod:`dvp.ray` and Spark share. Needs pyarrow."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._dvp import DvpError
from ._fit import Fitter
from ._scene import _columns as columns_of
from ._scene import table

if TYPE_CHECKING:
    import pyarrow as pa


class BatchFitter:
    """Fits the pictures of a column, batch by batch: a row per object, or one with ``error`` for a picture that failed.

    ``column`` holds pictures: bytes of files, paths or arrays; ``name`` the column with their names, which the rows carry as ``picture``
    (None: the paths, or numbers within the batch). All other options are those of :class:`dvp.Fitter`, which is made once, with its bank
    and memory. One thread: the engine gives a process to each core.
    """

    def __init__(
        self, column: str = "bytes", name: str | None = "path", *, pixel_mm: float | None = None, **options: Any
    ) -> None:
        self._column, self._name, self._pixel_mm = column, name, pixel_mm
        self._fitter = Fitter(**options)

    def __call__(self, batch: Any) -> pa.Table:
        """The objects of a batch: a table or record batch of pyarrow, or a mapping of columns."""
        pictures = _values(batch, self._column)
        if pictures is None:
            raise DvpError(f"the batch has no column {self._column!r}; it has {', '.join(_columns(batch))}")
        names = _values(batch, self._name) if self._name is not None else None
        if names is None:
            names = pictures if all(isinstance(picture, str) for picture in pictures) else list(range(len(pictures)))
        scenes = self._fitter.fit_many(pictures, threads=1)
        return table(scenes, names=[str(name) for name in names], pixel_mm=self._pixel_mm)


def map_in_arrow(column: str = "bytes", name: str | None = "path", **options: Any) -> Any:
    """The same for Spark: ``frame.mapInArrow(dvp.map_in_arrow(...), dvp.spark_schema())``, a function of an iterator of record batches.

    >>> import dvp, pyarrow
    >>> batch = pyarrow.record_batch({"path": ["missing.png"]})
    >>> [found] = dvp.map_in_arrow("path")([batch])
    >>> found.num_rows, found["error"].to_pylist()[0][:29]
    (1, 'missing.png: cannot be read: ')
    """

    def fit(batches: Iterable[pa.RecordBatch]) -> Iterator[pa.RecordBatch]:
        fitter = BatchFitter(column, name, **options)
        for batch in batches:
            yield from fitter(batch).to_batches()

    return fit


def spark_schema(*, pixel_mm: float | None = None) -> str:
    """The columns that :func:`map_in_arrow` gives, as Spark wants them told; with ``pixel_mm`` those in millimeters too.

    >>> import dvp
    >>> dvp.spark_schema().startswith("`picture` string, `stem` string, ")
    True
    """
    kinds = {"text": "string", "count": "bigint", "number": "double"}
    return ", ".join(f"`{name}` {kinds[kind]}" for name, kind, _ in columns_of([], [], pixel_mm))


def _columns(batch: Any) -> list[str]:
    return list(batch) if isinstance(batch, Mapping) else list(batch.schema.names)


def _values(batch: Any, column: str | None) -> list[Any] | None:
    if column not in _columns(batch):
        return None
    values = batch[column]
    if isinstance(values, np.ndarray):
        return list(values)
    if hasattr(values.type, "to_numpy") or "Tensor" in type(values.type).__name__:
        # Images of a tensor column come as arrays; text and bytes as Python has them.
        return [value for chunk in getattr(values, "chunks", [values]) for value in chunk.to_numpy(zero_copy_only=False)]
    return list(values.to_pylist())
