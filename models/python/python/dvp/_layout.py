"""How tensors become the numbers of scenes: what :mod:`dvp.torch` and :mod:`dvp.jax` share.

An item of a batch is one scene, its numbers one after the other: shapes, poses, colors, confidences, background.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _dvp
from ._dvp import DvpError


@dataclass(frozen=True)
class Framework:
    """What is asked of a framework of tensors."""

    broadcast_to: Callable[[Any, tuple[int, ...]], Any]
    concatenate: Callable[[list[Any], int], Any]
    #: A tensor of one value, of the type and on the device of another: (like, shape, value).
    full: Callable[[Any, tuple[int, ...], float], Any]


@dataclass(frozen=True)
class Plan:
    """A batch of scenes, laid out."""

    step: _dvp.SceneStep
    #: Batch x numbers of a scene.
    numbers: Any
    #: Extents of an image.
    image: tuple[int, int, int]
    #: Whether the tensors had no dimension of a batch.
    single: bool
    objects: int
    #: Names of the outlines, with their extents per scene.
    outlines: list[tuple[str, tuple[int, ...]]]

    def split(self, grads: npt.NDArray[Any]) -> dict[str, npt.NDArray[Any]]:
        """The columns of an array that is laid out as the numbers are: batch x extents of each tensor."""
        batch, objects = grads.shape[0], self.objects
        widths = [extents[-2] * extents[-1] for _, extents in self.outlines]
        ends = np.cumsum([objects * width for width in (sum(widths), 4, 3, 1)])
        shapes, poses, color, confidence, background = np.split(grads, ends, axis=1)
        poses = poses.reshape(batch, objects, 4)
        parts = dict(
            translation=poses[..., :2],
            scale=poses[..., 2],
            rotation=poses[..., 3],
            color=color.reshape(batch, objects, 3),
            confidence=confidence,
            background=background,
        )
        of_outlines = np.split(shapes.reshape(batch, objects, sum(widths)), np.cumsum(widths)[:-1], axis=2)
        for (name, extents), part in zip(self.outlines, of_outlines):
            parts[name] = part.reshape(batch, *extents)
        return parts


@functools.lru_cache(maxsize=64)
def _step(
    extents: tuple[int, int, int],
    rings: tuple[int, ...] | None,
    harmonics: int,
    vertices: int,
    edge: str,
    sigma_px: float,
    compositing: str,
    rgba: bool,
    double: bool,
) -> _dvp.SceneStep:
    return _dvp.SceneStep(extents, rings, harmonics, vertices, edge, sigma_px, compositing, rgba, double)


def plan(
    framework: Framework,
    *,
    size: tuple[int, int],
    efd: Any,
    rings: Any,
    translation: Any,
    scale: Any,
    rotation: Any,
    color: Any,
    confidence: Any,
    background: Any,
    vertices: int,
    edge: str | float,
    compositing: str,
    rgba: bool,
    double: bool,
) -> Plan:
    """Checks extents, puts in what was left away and lays out the numbers."""
    if (efd is None) == (rings is None):
        raise DvpError("give the shapes as efd or as rings, one of the two")
    outlines = _outlines(efd, rings)
    objects = int(outlines[0].shape[-3])
    parts = [(name, outline, tuple(outline.shape[-3:])) for name, outline in zip(_names(efd, rings), outlines)]
    parts += [
        ("translation", translation, (objects, 2)),
        ("scale", scale, (objects,)),
        ("rotation", rotation, (objects,)),
        ("color", color, (objects, 3)),
        ("confidence", confidence, (objects,)),
        ("background", background, (3,)),
    ]
    batches: dict[str, int] = {}
    for name, tensor, tail in parts:
        if tensor is None:
            continue
        shape = tuple(tensor.shape)
        if shape == tail:
            continue
        if shape[1:] != tail:
            raise DvpError(f"{name} has extents {shape}, must be {_shown(tail)} or batch x {_shown(tail)}")
        batches[name] = shape[0]
    batch = max(batches.values(), default=1)
    for name, count in batches.items():
        if count not in (1, batch):
            raise DvpError(f"{name} is a batch of {count}, others of {batch}")
    if min(batches.values(), default=1) == 0:
        batch = 0
    like = outlines[0]
    defaults = {"translation": 0.0, "scale": 1.0, "rotation": 0.0, "confidence": 1.0, "background": 1.0}
    laid: dict[str, Any] = {}
    for name, tensor, tail in parts:
        if tensor is None:
            if name not in defaults:
                raise DvpError(f"{name} is missing")
            tensor = framework.full(like, tail, defaults[name])
        laid[name] = framework.broadcast_to(tensor, (batch, *tail))
    shapes = [
        laid[name].reshape((batch, objects, int(tensor.shape[-2]) * int(tensor.shape[-1])))
        for name, tensor in zip(_names(efd, rings), outlines)
    ]
    poses = [laid["translation"], laid["scale"].reshape((batch, objects, 1)), laid["rotation"].reshape((batch, objects, 1))]
    flat = [
        framework.concatenate(shapes, 2) if len(shapes) > 1 else shapes[0],
        framework.concatenate(poses, 2),
        laid["color"],
        laid["confidence"],
        laid["background"],
    ]
    width = [int(_length(tensor)) for tensor in flat]
    numbers = framework.concatenate([tensor.reshape((batch, count)) for tensor, count in zip(flat, width)], 1)
    height_px, width_px = _size(size)
    law, sigma_px = (edge, 0.0) if isinstance(edge, str) else ("blur", float(edge))
    lengths = None if rings is None else tuple(int(ring.shape[-2]) for ring in outlines)
    harmonics = int(outlines[0].shape[-2]) if rings is None else 1
    step = _step(
        (width_px, height_px, objects), lengths, harmonics, vertices, law, sigma_px, compositing, rgba, double
    )
    extents = [(name, tail) for name, _, tail in parts[: len(outlines)]]
    return Plan(step, numbers, (4 if rgba else 3, height_px, width_px), not batches, objects, extents)


def _outlines(efd: Any, rings: Any) -> list[Any]:
    if rings is None:
        outlines, last, what = [efd], 4, "efd: objects x harmonics x 4"
    else:
        outlines, last, what = list(rings) if isinstance(rings, (list, tuple)) else [rings], 2, "rings: objects x vertices x 2"
    for outline in outlines:
        shape = tuple(outline.shape)
        if len(shape) not in (3, 4) or shape[-1] != last or shape[-3] != outlines[0].shape[-3]:
            raise DvpError(f"extents {shape}, must be those of {what}, with or without a batch before them")
    if not outlines:
        raise DvpError("rings is an empty list; give a tensor per ring")
    return outlines


def _names(efd: Any, rings: Any) -> list[str]:
    if rings is None:
        return ["efd"]
    return [f"rings[{k}]" for k in range(len(rings))] if isinstance(rings, (list, tuple)) else ["rings"]


def _length(tensor: Any) -> int:
    count = 1
    for extent in tensor.shape[1:]:
        count *= int(extent)
    return count


def _shown(extents: Sequence[int]) -> str:
    return " x ".join(str(extent) for extent in extents)


def _size(size: tuple[int, int]) -> tuple[int, int]:
    try:
        height, width = (int(side) for side in size)
    except (TypeError, ValueError) as error:
        raise DvpError(f"size {size!r}: must be (height, width)") from error
    if height < 1 or width < 1:
        raise DvpError(f"size {size!r}: sides must be at least 1")
    return height, width
