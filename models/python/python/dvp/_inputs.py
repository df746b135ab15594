"""What users hand over, checked and laid out for the native half."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from ._dvp import DvpError

#: A picture: an array (height x width, x 3 or x 4; uint8, or float from 0 to 1), the path of a file, the bytes of one, or a PIL image.
Picture = Union[npt.NDArray[Any], "os.PathLike[str]", str, bytes, bytearray, memoryview, Any]
#: Known shapes: ``"mdshr"``, the path of a bank file, or names with rows (a, b, c, d) of descriptors each.
Bank = Union[str, "os.PathLike[str]", Mapping[str, npt.ArrayLike]]

_JPEG = ("JPEG", "MPO")


def source(picture: Picture) -> tuple[Any, bool]:
    """The picture as the native half takes it, and whether it is known to have gone through a JPEG."""
    if isinstance(picture, (str, os.PathLike)):
        return os.fspath(picture), False
    if isinstance(picture, (bytes, bytearray, memoryview)):
        return bytes(picture), False
    if hasattr(picture, "getbands") and hasattr(picture, "convert"):
        return pixels(_of_pil(picture)), getattr(picture, "format", None) in _JPEG
    if picture is None or isinstance(picture, (bool, int, float, dict)):
        raise DvpError(
            f"a picture cannot be of type {type(picture).__name__}; give an array, a path, the bytes of a file or a PIL image"
        )
    return pixels(picture), False


def pixels(picture: Any) -> npt.NDArray[Any]:
    """Pixels as height x width x 3 or 4, uint8 or float32."""
    try:
        array = np.asarray(picture)
    except (TypeError, ValueError, RuntimeError) as error:
        raise DvpError(f"a picture of type {type(picture).__name__} is no array: {error}") from error
    if array.ndim == 2:
        array = np.broadcast_to(array[..., np.newaxis], (*array.shape, 3))
    if array.ndim != 3 or array.shape[2] not in (3, 4):
        raise DvpError(
            f"an array of shape {np.shape(picture)} is no picture; must be height x width, height x width x 3 or height x width x 4"
        )
    if array.dtype == np.uint8:
        return np.ascontiguousarray(array)
    if array.dtype.kind != "f":
        raise DvpError(
            f"an array of {array.dtype} is no picture; must be uint8, or float from 0 to 1 (of 16 bits: array / 65535)"
        )
    if array.size and not (array.min() >= 0 and array.max() <= 1):
        wrong = array[~((array >= 0) & (array <= 1))].flat[0]
        raise DvpError(f"a pixel is {wrong}; floats must lie from 0 to 1 (array / 255, numpy.clip, numpy.nan_to_num)")
    return np.ascontiguousarray(array, dtype=np.float32)


def _of_pil(image: Any) -> npt.NDArray[Any]:
    mode = image.mode
    if mode.startswith("I;16"):
        return np.asarray(image).astype(np.float64) / 65535
    if mode in ("I", "F"):
        raise DvpError(f"a PIL image of mode {mode} does not say where white is; make it an array from 0 to 1")
    is_translucent = mode in ("RGBA", "LA", "PA", "RGBa", "La") or "transparency" in image.info
    wanted = "RGBA" if is_translucent else "RGB"
    return np.asarray(image if mode == wanted else image.convert(wanted))


def labels(masks: Any) -> Any:
    """A label map as the native half takes it."""
    if isinstance(masks, (str, os.PathLike)):
        return os.fspath(masks)
    array = np.asarray(masks)
    if array.ndim != 2 or array.dtype.kind not in "iub":
        raise DvpError(f"an array of {array.dtype} and shape {array.shape} is no label map; must be whole numbers, height x width")
    if array.size and (int(array.min()) < 0 or int(array.max()) > 0xFFFF_FFFF):
        raise DvpError("a label is below 0 or above 4294967295")
    return np.ascontiguousarray(array, dtype=np.uint32)


def bank_text(bank: Bank | None) -> str:
    """A bank as the native half takes it: a name, a path or JSON."""
    if bank is None:
        return "none"
    if isinstance(bank, (str, os.PathLike)):
        return os.fspath(bank)
    if not isinstance(bank, Mapping):
        raise DvpError(f"a bank cannot be of type {type(bank).__name__}; give \"mdshr\", a path, or names with rows of descriptors")
    prototypes = []
    for name, rows in bank.items():
        array = np.asarray(rows, dtype=np.float64)
        if array.ndim != 2 or array.shape[1] != 4 or not np.isfinite(array).all():
            raise DvpError(f"shape {name!r} of the bank: must be finite rows (a, b, c, d), is an array of shape {array.shape}")
        prototypes.append({"name": str(name), "efd": array.tolist()})
    return json.dumps({"version": 1, "prototypes": prototypes})


def stem_of(picture: Picture, number: int) -> str:
    """What a picture is called: the stem of its file, or else its number."""
    if isinstance(picture, (str, os.PathLike)):
        return os.path.splitext(os.path.basename(os.fspath(picture)))[0]
    return f"{number:05}"
