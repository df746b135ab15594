"""Spark: `mapInArrow` on a real session of several processes gives the rows that `fit_many` gives."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import dvp

pyspark = pytest.importorskip("pyspark", reason="SPARK IS NOT TESTED: pip install pyspark")
pytest.importorskip("pyarrow")
pytest.importorskip("pandas", reason="SPARK IS NOT TESTED: it needs pandas for Arrow")
Image = pytest.importorskip("PIL.Image")
if shutil.which("java") is None and "JAVA_HOME" not in os.environ:
    pytest.skip("SPARK IS NOT TESTED: java is missing", allow_module_level=True)

COUNT = 60


@pytest.fixture(scope="module")
def session() -> Iterator[Any]:
    """Two workers of this machine, with the interpreter that runs the tests."""
    os.environ["PYSPARK_PYTHON"] = os.environ["PYSPARK_DRIVER_PYTHON"] = sys.executable
    builder = pyspark.sql.SparkSession.builder.master("local[2]").appName("dvp")
    settings = {"spark.ui.enabled": "false", "spark.driver.bindAddress": "127.0.0.1", "spark.driver.host": "127.0.0.1"}
    for name, value in settings.items():
        builder = builder.config(name, value)
    session = builder.getOrCreate()
    session.sparkContext.setLogLevel("ERROR")
    yield session
    session.stop()


def test_rows_are_objects(session: Any, tmp_path: Path) -> None:
    for k, scene in enumerate(dvp.generate(COUNT - 1, seed=31, size=(64, 64))):
        Image.fromarray(scene.render()).save(tmp_path / f"{k:05}.png")
    (tmp_path / "broken.png").write_bytes(b"no picture")
    frame = session.read.format("binaryFile").load(str(tmp_path)).select("path", "content").repartition(4)
    found = frame.mapInArrow(dvp.map_in_arrow("content", bank="mdshr"), dvp.spark_schema()).collect()
    rows = sorted((Path(row["picture"]).name, row["object"] or 0, row["area_px2"], row["error"]) for row in found)
    paths = sorted(tmp_path.glob("*.png"))
    expected = dvp.measures(dvp.fit_many(paths, bank="mdshr"), names=[path.name for path in paths])
    columns = (expected[name] for name in ("picture", "object", "area_px2", "error"))
    wanted = sorted((name, number or 0, area, error) for name, number, area, error in zip(*columns))
    assert len(rows) == len(wanted) and len(rows) > COUNT
    assert [row[:3] for row in rows] == [row[:3] for row in wanted]
    assert [row[0] for row in rows if row[3] is not None] == ["broken.png"]
