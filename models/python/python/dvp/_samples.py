"""Random scenes, and scores of scenes."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, TypedDict

import numpy as np
import numpy.typing as npt

from . import _dvp
from ._dvp import DvpError
from ._inputs import Bank, bank_text, labels, pixels
from ._scene import Scene


class Scores(TypedDict):
    """Means over the images that were scored; None where nothing is known."""

    n: int
    mae: float | None
    mse: float | None
    ssim: float | None
    iou: float | None
    ari: float | None
    exact_count: float | None
    failed: list[dict[str, str]]


def generate(
    count: int = 1,
    *,
    seed: int = 1234,
    first: int = 0,
    preset: str = "mds-hr",
    bank: Bank = "mdshr",
    size: tuple[int, int] | None = None,
    visible: tuple[int, int] | None = None,
    slots: int | None = None,
    placements: int | None = None,
    margin: float | None = None,
    scale: tuple[float, float] | None = None,
    color: tuple[float, float] | None = None,
    background: tuple[float, float] | None = None,
    compositing: str | None = None,
) -> list[Scene]:
    """Random scenes: those with the numbers ``first``, ``first + 1``, ... of the data set ``seed``, as ``dvp generate`` draws them.

    ``preset`` is ``"mds-hr"`` (128 x 128 pixels, soft edges, blended overlaps) or ``"multi-dsprites"`` (64 x 64, hard edges,
    occlusion); what is given besides changes it: ``size`` (width, height), ``visible`` (fewest and most objects), ``slots``,
    ``placements``, ``margin``, ``scale``, ``color``, ``background`` (ranges), ``compositing``.

    >>> import dvp
    >>> dvp.generate(2, first=5) == dvp.generate(7)[5:]
    True
    """
    for name, value in (("count", count), ("seed", seed), ("first", first)):
        if not 0 <= value < 1 << 63:
            raise DvpError(f"{name}={value}: must be from 0 to 2**63 - 1")
    if count > 1 << 24:
        raise DvpError(f"count={count}: must be 2**24 at most; draw them in parts, with first")
    settings = dict(
        size=size,
        visible=visible,
        slots=slots,
        placements=placements,
        margin=margin,
        scale=scale,
        color=color,
        background=background,
        compositing=compositing,
    )
    try:
        found = _dvp.generate((first, count), seed, preset, bank_text(bank), settings)
    except (TypeError, OverflowError) as error:
        raise DvpError(f"settings {settings}: {error}") from error
    return [Scene(native) for native in found]


def evaluate(
    scenes: Sequence[Scene], images: Sequence[npt.ArrayLike], truths: Sequence[Any] | None = None
) -> Scores:
    """Scores scenes against the images that they were found in and, where given, against what those were drawn from, in the paper's
    columns: MAE, MSE and SSIM compare images; IoU (pooled), ARI and the share of exact counts compare which pixels belong to which
    object.

    A truth is a :class:`Scene`, a label map (height x width, or the path of a file) or None. Rules: those of ``dvp evaluate``.

    >>> import dvp
    >>> truth = dvp.generate(2)
    >>> scores = dvp.evaluate(truth, [scene.render() for scene in truth], truth)
    >>> scores["n"], scores["ari"], scores["exact_count"]
    (2, 1.0, 1.0)
    """
    given = list(truths) if truths is not None else [None] * len(scenes)
    natives = [truth._native if isinstance(truth, Scene) else None if truth is None else labels(truth) for truth in given]
    planes = [_rgb(pixels(image)) for image in images]
    text = _dvp.evaluate([scene._native for scene in scenes], planes, natives)
    scores: Scores = json.loads(text)
    return scores


def _rgb(image: npt.NDArray[Any]) -> npt.NDArray[np.float32]:
    if image.shape[2] == 4:
        raise DvpError("images with alpha cannot be compared; put them over a color first")
    scaled = image / np.float32(255) if image.dtype == np.uint8 else image
    return np.ascontiguousarray(scaled, dtype=np.float32)
