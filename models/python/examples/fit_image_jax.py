"""Fits circles to an image through the renderer, in JAX: python examples/fit_image_jax.py"""

import jax
import jax.numpy as jnp

import dvp
import dvp.jax


def main(objects: int = 6, harmonics: int = 6, steps: int = 300) -> tuple[float, float]:
    picture = jnp.asarray(dvp.generate(seed=5)[0].render()).transpose(2, 0, 1) / 255
    efd = jnp.zeros((objects, harmonics, 4)).at[:, 0].set(jnp.array([1.0, 0.0, 0.0, 1.0]))
    numbers = dict(
        efd=efd,
        translation=0.2 + 0.6 * jax.random.uniform(jax.random.key(1), (objects, 2)),
        log_scale=jnp.full(objects, -2.0),
        color=jnp.zeros((objects, 3)),
        background=jnp.zeros(3),
    )

    def loss(numbers, edge):
        place = dict(efd=numbers["efd"], translation=numbers["translation"], scale=jnp.exp(numbers["log_scale"]))
        colors = {name: jax.nn.sigmoid(numbers[name]) for name in ("color", "background")}
        return dvp.jax.loss(picture, **place, **colors, edge=edge)

    # Adam, written out: no other package is needed.
    mean = jax.tree.map(jnp.zeros_like, numbers)
    square = jax.tree.map(jnp.zeros_like, numbers)
    losses = []
    for step in range(1, steps + 1):
        # Soft edges see far at first, sharp ones see well at last; a few softnesses, as each is a layout of its own.
        value, grads = jax.value_and_grad(loss)(numbers, 8.0 / 2 ** (5 * step // (steps + 1)))
        mean = jax.tree.map(lambda m, g: 0.9 * m + 0.1 * g, mean, grads)
        square = jax.tree.map(lambda s, g: 0.999 * s + 0.001 * g * g, square, grads)
        rate = 0.02 * (1 - 0.999**step) ** 0.5 / (1 - 0.9**step)
        numbers = jax.tree.map(lambda x, m, s: x - rate * m / (jnp.sqrt(s) + 1e-8), numbers, mean, square)
        losses.append(float(value))
    print(f"{objects} objects: mean absolute error {losses[0]:.4f}, then {losses[-1]:.4f}")
    return losses[0], losses[-1]


if __name__ == "__main__":
    main()
