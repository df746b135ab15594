"""The renderer and its loss in JAX, differentiable with respect to every number of the scenes: a custom_vjp around callbacks.

Everything runs on the processor, a scene per core, under jit as well; float32, and float64 where JAX has it switched on. Reverse mode
only, once.

>>> import jax, jax.numpy as jnp, dvp.jax
>>> place = dict(translation=jnp.array([[0.5, 0.5]]), scale=jnp.array([0.3]), color=jnp.array([[1.0, 0.0, 0.0]]))
>>> circle = jnp.array([[[1.0, 0.0, 0.0, 1.0]]])
>>> jax.grad(lambda efd: dvp.jax.render(efd=efd, size=(32, 32), **place).sum())(circle).shape
(1, 1, 4)
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from . import _dvp
from ._dvp import DvpError
from ._layout import Framework, Plan, plan

__all__ = ["loss", "render"]

_JAX = Framework(
    broadcast_to=jnp.broadcast_to,
    concatenate=lambda arrays, axis: jnp.concatenate(arrays, axis),
    full=lambda like, shape, value: jnp.full(shape, value, dtype=like.dtype),
)


# It has no types of its own.
_extents: Any = jax.ShapeDtypeStruct


def _flat(array: Any) -> Any:
    return np.ascontiguousarray(array).reshape(-1)


def _call(function: Any, shape: Any, *arrays: Any) -> Any:
    return jax.pure_callback(function, shape, *arrays, vmap_method="sequential")


@partial(jax.custom_vjp, nondiff_argnums=(0, 1))
def _render(step: _dvp.SceneStep, image: tuple[int, ...], numbers: Any) -> Any:
    shape = (numbers.shape[0], *image)

    def paint(numbers: Any) -> Any:
        images = np.empty(shape, numbers.dtype)
        step.render(_flat(numbers), images.reshape(-1))
        return images

    return _call(paint, _extents(shape, numbers.dtype), numbers)


def _render_forward(step: _dvp.SceneStep, image: tuple[int, ...], numbers: Any) -> tuple[Any, Any]:
    return _render(step, image, numbers), numbers


def _render_backward(step: _dvp.SceneStep, image: tuple[int, ...], numbers: Any, grad: Any) -> tuple[Any]:
    def pull(numbers: Any, grad: Any) -> Any:
        return step.render_vjp(_flat(numbers), _flat(grad)).reshape(numbers.shape)

    return (_call(pull, _extents(numbers.shape, numbers.dtype), numbers, grad),)


_render.defvjp(_render_forward, _render_backward)


@partial(jax.custom_vjp, nondiff_argnums=(0, 1))
def _loss(step: _dvp.SceneStep, kind: str, numbers: Any, targets: Any) -> Any:
    shape = _extents((numbers.shape[0],), numbers.dtype)
    return _call(lambda x, y: step.loss(_flat(x), _flat(y), kind, False)[0], shape, numbers, targets)


def _loss_forward(step: _dvp.SceneStep, kind: str, numbers: Any, targets: Any) -> tuple[Any, Any]:
    shapes = [_extents(shape, numbers.dtype) for shape in ((numbers.shape[0],), numbers.shape)]

    def both(numbers: Any, targets: Any) -> Any:
        values, grads = step.loss(_flat(numbers), _flat(targets), kind, True)
        return values, grads.reshape(numbers.shape)

    values, grads = _call(both, shapes, numbers, targets)
    return values, (grads, targets)


def _loss_backward(step: _dvp.SceneStep, kind: str, saved: Any, grad: Any) -> tuple[Any, Any]:
    grads, targets = saved
    return grads * grad[:, None], jnp.zeros_like(targets)


_loss.defvjp(_loss_forward, _loss_backward)


def _plan(options: dict[str, Any]) -> Plan:
    names = ("efd", "rings", "translation", "scale", "rotation", "color", "confidence", "background")
    arrays = {}
    for name in names:
        value = options[name]
        if value is None:
            continue
        is_list = name == "rings" and isinstance(value, (list, tuple))
        arrays[name] = [jnp.asarray(ring) for ring in value] if is_list else jnp.asarray(value)
    listed = [array for value in arrays.values() for array in (value if isinstance(value, list) else [value])]
    types = {array.dtype for array in listed}
    if len(types) != 1 or types - {np.dtype(np.float32), np.dtype(np.float64)}:
        raise DvpError(f"arrays must all be float32, or all float64; got {sorted(map(str, types))}")
    return plan(_JAX, **{**options, **arrays}, double=np.dtype(np.float64) in types)


def render(
    *,
    size: tuple[int, int],
    efd: Any = None,
    rings: Any | Sequence[Any] = None,
    translation: Any = None,
    scale: Any = None,
    rotation: Any = None,
    color: Any = None,
    confidence: Any = None,
    background: Any = None,
    vertices: int = 64,
    edge: str | float = "area",
    compositing: str = "over",
    rgba: bool = False,
) -> jax.Array:
    """Paints scenes: batch x 3 x height x width, or x 4. Dimensions, units and options are those of ``dvp.torch.render``."""
    laid = _plan(dict(locals()))
    image: jax.Array = _render(laid.step, laid.image, laid.numbers)
    return image[0] if laid.single else image


def loss(
    target: Any,
    *,
    kind: str = "mae",
    efd: Any = None,
    rings: Any | Sequence[Any] = None,
    translation: Any = None,
    scale: Any = None,
    rotation: Any = None,
    color: Any = None,
    confidence: Any = None,
    background: Any = None,
    vertices: int = 64,
    edge: str | float = "area",
    compositing: str = "over",
) -> jax.Array:
    """The pixel loss of each scene against its target, a number per scene; the target gets no gradient. As ``dvp.torch.loss``."""
    options = {name: value for name, value in locals().items() if name not in ("target", "kind")}
    target = jnp.asarray(target)
    if target.ndim not in (3, 4) or target.shape[-3] not in (3, 4):
        raise DvpError("target must be an array of (batch x) 3 x height x width, or x 4")
    laid = _plan(dict(options, size=target.shape[-2:], rgba=target.shape[-3] == 4))
    numbers, single = laid.numbers, laid.single and target.ndim == 3
    if target.dtype != numbers.dtype:
        raise DvpError(f"target is {target.dtype}, the scenes are {numbers.dtype}; cast one of them")
    if target.ndim == 4 and target.shape[0] != numbers.shape[0]:
        if numbers.shape[0] != 1:
            raise DvpError(f"target is a batch of {target.shape[0]}, the scenes of {numbers.shape[0]}")
        numbers = jnp.broadcast_to(numbers, (target.shape[0], numbers.shape[1]))
    values: jax.Array = _loss(laid.step, kind, numbers, jnp.broadcast_to(target, (numbers.shape[0], *laid.image)))
    return values[0] if single else values
