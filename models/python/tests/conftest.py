"""What the tests share: pictures that are drawn here, and the repository's shipped ones."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

PICTURES = Path(__file__).parents[3] / "pictures"


@pytest.fixture
def square() -> Any:
    """A blue square of 32 pixels on white."""
    picture = np.full((64, 64, 3), 255, np.uint8)
    picture[16:48, 16:48] = (30, 60, 200)
    return picture


@pytest.fixture
def png(square: Any) -> bytes:
    """The same as the bytes of a PNG."""
    image = pytest.importorskip("PIL.Image")
    buffer = io.BytesIO()
    image.fromarray(square).save(buffer, "PNG")
    return buffer.getvalue()


@pytest.fixture
def shipped() -> Path:
    """A picture of the repository."""
    return PICTURES / "shapes.png"
