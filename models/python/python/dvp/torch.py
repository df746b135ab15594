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

import torch
from torch.autograd.function import once_differentiable

from . import _dvp
from ._dvp import DvpError
from ._layout import Framework, Plan, plan

__all__ = ["loss", "render"]

_TORCH = Framework(
    broadcast_to=torch.broadcast_to,
    concatenate=torch.cat,
    full=lambda like, shape, value: torch.full(shape, value, dtype=like.dtype, device=like.device),
)


def _flat(tensor: torch.Tensor) -> Any:
    return tensor.detach().cpu().contiguous().numpy().reshape(-1)


def _tensor(array: Any, like: torch.Tensor, shape: tuple[int, ...]) -> torch.Tensor:
    return torch.from_numpy(array).reshape(shape).to(like.device)


class _Render(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, numbers: torch.Tensor, step: _dvp.SceneStep, image: tuple[int, ...]) -> torch.Tensor:
        ctx.save_for_backward(numbers)
        ctx.step = step
        # Memory of PyTorch, which gives the same out again.
        images = torch.empty((numbers.shape[0], *image), dtype=numbers.dtype)
        step.render(_flat(numbers), images.numpy().reshape(-1))
        return images.to(numbers.device)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: torch.Tensor) -> tuple[torch.Tensor, None, None]:
        (numbers,) = ctx.saved_tensors
        pulled = ctx.step.render_vjp(_flat(numbers), _flat(grad))
        return _tensor(pulled, numbers, tuple(numbers.shape)), None, None


class _Loss(torch.autograd.Function):
    @staticmethod
    def forward(
        ctx: Any, numbers: torch.Tensor, targets: torch.Tensor, step: _dvp.SceneStep, kind: str
    ) -> torch.Tensor:
        backward = ctx.needs_input_grad[0]
        values, grads = step.loss(_flat(numbers), _flat(targets), kind, backward)
        if backward:
            ctx.save_for_backward(_tensor(grads, numbers, tuple(numbers.shape)))
        return _tensor(values, numbers, (numbers.shape[0],))

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: torch.Tensor) -> tuple[torch.Tensor, None, None, None]:
        (own,) = ctx.saved_tensors
        return own * grad[:, None], None, None, None


def _plan(options: dict[str, Any]) -> Plan:
    given = {name: value for name, value in options.items() if isinstance(value, torch.Tensor)}
    rings = options["rings"]
    if isinstance(rings, (list, tuple)):
        given.update({f"rings[{k}]": ring for k, ring in enumerate(rings)})
    for name in ("efd", "rings", "translation", "scale", "rotation", "color", "confidence", "background"):
        value = options[name]
        if value is not None and name not in given and not (name == "rings" and isinstance(value, (list, tuple))):
            raise DvpError(f"{name} is of type {type(value).__name__}, must be a tensor")
    types = {tensor.dtype for tensor in given.values()}
    if types - {torch.float32, torch.float64} or len(types) != 1:
        names = ", ".join(f"{name}: {tensor.dtype}" for name, tensor in given.items())
        raise DvpError(f"tensors must all be float32, or all float64; got {names or 'none'}")
    return plan(_TORCH, **options, double=torch.float64 in types)


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
    laid = _plan(options)
    image: torch.Tensor = _Render.apply(laid.numbers, laid.step, laid.image)
    return image[0] if laid.single else image


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
    height, width = int(target.shape[-2]), int(target.shape[-1])
    laid = _plan(dict(options, size=(height, width), rgba=target.shape[-3] == 4))
    numbers, single = laid.numbers, laid.single and target.dim() == 3
    if target.dtype != numbers.dtype:
        raise DvpError(f"target is {target.dtype}, the scenes are {numbers.dtype}; cast one of them")
    if target.dim() == 4 and target.shape[0] != numbers.shape[0]:
        if numbers.shape[0] != 1:
            raise DvpError(f"target is a batch of {target.shape[0]}, the scenes of {numbers.shape[0]}")
        numbers = numbers.expand(target.shape[0], -1)
    targets = target.expand(numbers.shape[0], *laid.image)
    values: torch.Tensor = _Loss.apply(numbers, targets, laid.step, kind)
    return values[0] if single else values
