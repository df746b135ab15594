"""The renderer and its loss in PyTorch, differentiable with respect to every number of the scenes.

Everything runs on the processor, a scene per core; tensors of other devices are brought there and back. Both work in float32 and in
float64. Gradients are those of the core's own backward pass: once differentiable.

>>> import torch, dvp.torch
>>> circle = torch.tensor([[[1.0, 0.0, 0.0, 1.0]]], requires_grad=True)  # one object, one harmonic
>>> place = dict(translation=torch.tensor([[0.5, 0.5]]), scale=torch.tensor([0.3]), color=torch.tensor([[1.0, 0.0, 0.0]]))
>>> image = dvp.torch.render(efd=circle, size=(32, 32), **place)
>>> image.shape
torch.Size([3, 32, 32])
>>> image.sum().backward()
>>> circle.grad.shape
torch.Size([1, 1, 4])
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from torch.autograd.function import once_differentiable

from ._dvp import DvpError
from ._layout import Framework, Plan, plan

__all__ = ["loss", "render"]

# Numbers are laid out outside of the graph: one node of it costs less than a dozen.
_NUMPY = Framework(
    broadcast_to=np.broadcast_to,
    concatenate=lambda arrays, axis: np.concatenate(arrays, axis),
    full=lambda like, shape, value: np.full(shape, value, dtype=like.dtype),
)

#: The tensors of a scene, in the order in which the nodes take them; of rings there may be several.
_NAMES = ("translation", "scale", "rotation", "color", "confidence", "background")


def _array(tensor: torch.Tensor) -> Any:
    return tensor.detach().cpu().numpy()


def _flat(tensor: torch.Tensor) -> Any:
    return _array(tensor.contiguous()).reshape(-1)


class _Scenes:
    """What a node keeps of its tensors: how they are laid out, and what they were."""

    def __init__(self, options: dict[str, Any], names: list[str], tensors: Sequence[torch.Tensor]) -> None:
        arrays: dict[str, Any] = {name: None for name in ("efd", "rings", *_NAMES)}
        arrays.update({name: _array(tensor) for name, tensor in zip(names, tensors)})
        rings = [arrays.pop(name) for name in names if name.startswith("rings[")]
        if rings:
            arrays["rings"] = rings
        double = tensors[0].dtype == torch.float64
        self.plan: Plan = plan(_NUMPY, **options, **arrays, double=double)
        self.numbers = self.plan.numbers
        self.names = names
        self.shapes = [tuple(tensor.shape) for tensor in tensors]
        self.device = tensors[0].device

    def gradients(self, grads: Any, needed: Sequence[bool]) -> list[torch.Tensor | None]:
        """The gradient of each tensor from that of the numbers; shared tensors get the sum over the batch."""
        parts = self.plan.split(grads.reshape(self.numbers.shape))
        found: list[torch.Tensor | None] = []
        for name, shape, is_needed in zip(self.names, self.shapes, needed):
            if not is_needed:
                found.append(None)
                continue
            part = parts[name]
            if shape != part.shape:
                part = part.sum(axis=0, keepdims=len(shape) == part.ndim)
            found.append(torch.from_numpy(np.ascontiguousarray(part)).to(self.device))
        return found


class _Render(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, options: dict[str, Any], names: list[str], *tensors: torch.Tensor) -> torch.Tensor:
        scenes = ctx.scenes = _Scenes(options, names, tensors)
        laid = scenes.plan
        # Memory of PyTorch, which gives the same out again.
        images = torch.empty((laid.numbers.shape[0], *laid.image), dtype=tensors[0].dtype)
        laid.step.render(laid.numbers.reshape(-1), images.numpy().reshape(-1))
        return (images[0] if laid.single else images).to(scenes.device)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: torch.Tensor) -> tuple[torch.Tensor | None, ...]:
        scenes: _Scenes = ctx.scenes
        pulled = scenes.plan.step.render_vjp(scenes.numbers.reshape(-1), _flat(grad))
        return None, None, *scenes.gradients(pulled, ctx.needs_input_grad[2:])


class _Loss(torch.autograd.Function):
    @staticmethod
    def forward(
        ctx: Any, options: dict[str, Any], names: list[str], target: torch.Tensor, kind: str, *tensors: torch.Tensor
    ) -> torch.Tensor:
        scenes = ctx.scenes = _Scenes(options, names, tensors)
        laid = scenes.plan
        count = laid.numbers.shape[0]
        single = laid.single and target.dim() == 3
        if target.dim() == 4 and target.shape[0] != count:
            if count != 1:
                raise DvpError(f"target is a batch of {target.shape[0]}, the scenes of {count}")
            count = target.shape[0]
            scenes.numbers = np.repeat(laid.numbers, count, axis=0)
        targets = _flat(target.expand(count, *laid.image))
        backward = any(ctx.needs_input_grad[4:])
        values, ctx.grads = laid.step.loss(scenes.numbers.reshape(-1), targets, kind, backward)
        losses = torch.from_numpy(values).to(scenes.device)
        return losses[0] if single else losses

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: torch.Tensor) -> tuple[torch.Tensor | None, ...]:
        scenes: _Scenes = ctx.scenes
        own = ctx.grads.reshape(scenes.numbers.shape) * _array(grad).reshape(-1, 1)
        return None, None, None, None, *scenes.gradients(own, ctx.needs_input_grad[4:])


def _tensors(options: dict[str, Any]) -> tuple[list[str], list[torch.Tensor]]:
    """Takes the tensors out of the options: their names, and themselves."""
    given: dict[str, Any] = {}
    for name in ("efd", "rings", *_NAMES):
        value = options.pop(name)
        if name == "rings" and isinstance(value, (list, tuple)):
            given.update({f"rings[{k}]": ring for k, ring in enumerate(value)})
        elif value is not None:
            given[name] = value
    for name, value in given.items():
        if not isinstance(value, torch.Tensor):
            raise DvpError(f"{name} is of type {type(value).__name__}, must be a tensor")
    types = {tensor.dtype for tensor in given.values()}
    if types - {torch.float32, torch.float64} or len(types) != 1:
        names = ", ".join(f"{name}: {tensor.dtype}" for name, tensor in given.items())
        raise DvpError(f"tensors must all be float32, or all float64; got {names or 'none'}")
    return list(given), list(given.values())


def render(
    *,
    size: tuple[int, int],
    efd: torch.Tensor | None = None,
    rings: torch.Tensor | Sequence[torch.Tensor] | None = None,
    translation: torch.Tensor | None = None,
    scale: torch.Tensor | None = None,
    rotation: torch.Tensor | None = None,
    color: torch.Tensor | None = None,
    confidence: torch.Tensor | None = None,
    background: torch.Tensor | None = None,
    vertices: int = 64,
    edge: str | float = "area",
    compositing: str = "over",
    rgba: bool = False,
) -> torch.Tensor:
    """Paints scenes: batch x 3 x height x width, or x 4 with premultiplied colors and alpha on nothing.

    ``size``
        (height, width) of the images.
    ``efd``
        Descriptors, (batch x) objects x harmonics x 4, drawn with ``vertices`` vertices each, the repeated one counted.
    ``rings``
        Outlines instead, (batch x) objects x vertices x 2, in a frame of their own or, without a pose, in scene units. Of a list the
        others are rings of the same objects: what lies inside of an odd number of them is filled.
    ``translation``, ``scale``, ``rotation``
        Where the outlines stand: (batch x) objects x 2, objects, objects (radians). A vertex v goes to ``scale * R(rotation) @ v +
        translation``. Left away: 0, 1, 0.
    ``color``, ``confidence``, ``background``
        (Batch x) objects x 3, objects (opacity; left away: 1), 3 (left away: white); 0 to 1.
    ``edge``
        How coverage falls off: ``"area"`` (the pixel's area inside, as drawing programs paint), ``"reference"`` (the paper's), or the
        softness of a logistic edge in pixels, which is smooth and reaches farther.
    ``compositing``
        ``"over"``: later objects hide earlier ones; ``"blend"``: overlaps show the mean of the colors, as in the paper.

    *Units*: the shorter side of an image is 1, x to the right, y down. A dimension of a batch may be left away, or be 1, where all scenes
    share a tensor; if all leave it away, so does the result. Raises :class:`dvp.DvpError` for extents that do not go together and
    numbers that are not finite.
    """
    options = dict(locals())
    names, tensors = _tensors(options)
    image: torch.Tensor = _Render.apply(options, names, *tensors)
    return image


def loss(
    target: torch.Tensor,
    *,
    kind: str = "mae",
    efd: torch.Tensor | None = None,
    rings: torch.Tensor | Sequence[torch.Tensor] | None = None,
    translation: torch.Tensor | None = None,
    scale: torch.Tensor | None = None,
    rotation: torch.Tensor | None = None,
    color: torch.Tensor | None = None,
    confidence: torch.Tensor | None = None,
    background: torch.Tensor | None = None,
    vertices: int = 64,
    edge: str | float = "area",
    compositing: str = "over",
) -> torch.Tensor:
    """The pixel loss of each scene against its target, without an image in between: a number per scene of the batch.

    ``target`` is (batch x) 3 x height x width, or x 4 (premultiplied), and gets no gradient; ``kind`` is ``"mae"``, the mean of
    abs(a - b) over pixels and channels, or ``"mse"``, that of (a - b) ** 2. All else as in :func:`render`.
    """
    options = {name: value for name, value in locals().items() if name not in ("target", "kind")}
    if not isinstance(target, torch.Tensor) or target.dim() not in (3, 4) or target.shape[-3] not in (3, 4):
        raise DvpError("target must be a tensor of (batch x) 3 x height x width, or x 4")
    names, tensors = _tensors(options)
    if target.dtype != tensors[0].dtype:
        raise DvpError(f"target is {target.dtype}, the scenes are {tensors[0].dtype}; cast one of them")
    options.update(size=tuple(target.shape[-2:]), rgba=target.shape[-3] == 4)
    values: torch.Tensor = _Loss.apply(options, names, target.detach(), kind, *tensors)
    return values
