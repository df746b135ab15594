"""The renderer and its loss in frameworks: images and gradients are the core's, and pass the frameworks' own checks."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import dvp

torch = pytest.importorskip("torch")
import dvp.torch  # noqa: E402

SIZE = (24, 32)


def scene(batch: int, objects: int = 2, harmonics: int = 3, dtype: Any = None, seed: int = 5) -> dict[str, Any]:
    """Wobbly disks that overlap; every number is there, and apart from what is not smooth."""
    rng = np.random.default_rng(seed)
    efd = np.zeros((batch, objects, harmonics, 4))
    efd[..., 0, :] = (1, 0, 0, 1)
    efd += 0.05 * rng.standard_normal(efd.shape)
    parts = dict(
        efd=efd,
        translation=rng.uniform(0.35, 0.75, (batch, objects, 2)),
        scale=rng.uniform(0.15, 0.3, (batch, objects)),
        rotation=rng.uniform(-1, 1, (batch, objects)),
        color=rng.uniform(0.2, 0.8, (batch, objects, 3)),
        confidence=rng.uniform(0.5, 0.9, (batch, objects)),
        background=rng.uniform(0.2, 0.8, (batch, 3)),
    )
    return {name: torch.tensor(part, dtype=dtype or torch.float64, requires_grad=True) for name, part in parts.items()}


def rings_of(parts: dict[str, Any], vertices: int = 9) -> dict[str, Any]:
    """The same with outlines as vertices, each with a hole."""
    batch, objects = parts["scale"].shape
    angle = torch.arange(vertices, dtype=torch.float64) * (2 * np.pi / vertices)
    ring = torch.stack([angle.cos(), angle.sin()], 1).expand(batch, objects, vertices, 2)
    rest = {name: part for name, part in parts.items() if name != "efd"}
    return dict(rest, rings=[ring.clone().requires_grad_(), (0.4 * ring[..., ::2, :]).clone().requires_grad_()])


def check(function: Any, parts: dict[str, Any], atol: float = 1e-5) -> None:
    names = [name for name in parts if name != "rings"]
    rings = parts.get("rings", [])

    def of(*tensors: Any) -> Any:
        given = dict(zip(names, tensors))
        if rings:
            given["rings"] = list(tensors[len(names) :])
        return function(**given)

    assert torch.autograd.gradcheck(of, [*(parts[name] for name in names), *rings], eps=1e-6, atol=atol, rtol=1e-4)


@pytest.mark.parametrize("compositing", ["over", "blend"])
@pytest.mark.parametrize("edge", [1.5, "area"])
@pytest.mark.parametrize("rgba", [False, True])
def test_gradcheck_of_images(edge: Any, compositing: str, rgba: bool) -> None:
    options = dict(size=SIZE, edge=edge, compositing=compositing, rgba=rgba, vertices=12)
    parts = scene(2)
    if rgba:
        # What is painted on nothing has no background.
        parts["background"] = parts["background"].detach().requires_grad_(False)
    check(lambda **given: dvp.torch.render(**given, **options), parts)


@pytest.mark.parametrize("kind", ["mae", "mse"])
def test_gradcheck_of_losses(kind: str) -> None:
    target = torch.tensor(np.random.default_rng(1).uniform(0, 1, (2, 3, *SIZE)))
    for parts in (scene(2), rings_of(scene(2))):
        options = dict(kind=kind, edge=1.5, compositing="over", vertices=12)
        check(lambda **given: dvp.torch.loss(target, **given, **options), parts)


def test_gradcheck_of_rings_with_holes() -> None:
    check(lambda **given: dvp.torch.render(**given, size=SIZE, edge=1.5), rings_of(scene(1)))


def test_images_are_those_of_scenes() -> None:
    for truth in dvp.generate(4, seed=3):
        objects = truth.objects
        count = max(len(o.shape["efd"]) for o in objects)
        efd = np.stack([np.pad(np.array(o.shape["efd"]), ((0, count - len(o.shape["efd"])), (0, 0))) for o in objects])
        given = dict(
            efd=efd,
            translation=[o.translation for o in objects],
            scale=[o.scale for o in objects],
            rotation=[o.rotation for o in objects],
            color=[o.color for o in objects],
            background=truth.background,
        )
        tensors = {name: torch.tensor(np.asarray(value, np.float32)) for name, value in given.items()}
        image = dvp.torch.render(**tensors, size=(128, 128), edge="reference", compositing="blend")
        assert np.allclose(image.numpy().transpose(1, 2, 0), truth.render(dtype=np.float32), atol=1e-5)
        again = dvp.torch.loss(image, **tensors, edge="reference", compositing="blend")
        assert again.shape == () and float(again) == 0


def test_the_loss_is_that_of_the_image() -> None:
    parts = scene(3, dtype=torch.float32)
    target = torch.rand(3, 3, *SIZE, generator=torch.Generator().manual_seed(2))
    image = dvp.torch.render(**parts, size=SIZE)
    expected = (image - target).abs().mean(dim=(1, 2, 3))
    own = dvp.torch.loss(target, **parts)
    assert torch.allclose(own, expected, atol=1e-6)
    wanted = torch.autograd.grad(expected.sum(), list(parts.values()))
    found = torch.autograd.grad(own.sum(), list(parts.values()))
    for name, a, b in zip(parts, wanted, found):
        assert torch.allclose(a, b, atol=1e-5), name


def test_shared_tensors_are_spread_and_their_gradients_added() -> None:
    parts = scene(3)
    shared = dict(parts, efd=parts["efd"][0].detach().requires_grad_())
    apart = dict(parts, efd=parts["efd"][:1].expand(3, -1, -1, -1).detach().clone().requires_grad_())
    images = [dvp.torch.render(**given, size=SIZE) for given in (shared, apart)]
    assert torch.equal(*images)
    for image in images:
        image.square().sum().backward()
    assert torch.allclose(shared["efd"].grad, apart["efd"].grad.sum(0))
    assert dvp.torch.render(**{k: v[0] for k, v in parts.items()}, size=SIZE).shape == (3, *SIZE)


def test_tensors_that_do_not_go_together_are_refused() -> None:
    parts = {name: part.detach() for name, part in scene(2).items()}
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"color": parts["color"][:, :1]}, "color has extents"),
        ({"scale": parts["scale"].float()}, "float32, or all float64"),
        ({"scale": parts["scale"].int()}, "float32, or all float64"),
        ({"background": parts["background"].expand(2, 3)[:1].expand(3, 3)}, "batch of"),
        ({"efd": parts["efd"][..., :3]}, "harmonics x 4"),
        ({"efd": None}, "one of the two"),
        ({"color": None}, "color is missing"),
        ({"color": [1, 2, 3]}, "color is of type list"),
        ({"translation": parts["translation"] * np.nan}, "item 0: .*NaN"),
        ({"size": (0, 4)}, "size"),
        ({"size": 5}, "size"),
        ({"size": (10**6, 10**6)}, "pixels"),
        ({"edge": "soft"}, "edge"),
        ({"edge": -1.0}, "softness"),
        ({"compositing": "under"}, "compositing"),
        ({"vertices": 2}, "distinct points"),
    ]
    for change, words in wrong:
        with pytest.raises(dvp.DvpError, match=words):
            dvp.torch.render(**{**parts, "size": SIZE, **change})
    with pytest.raises(dvp.DvpError, match="target"):
        dvp.torch.loss(torch.zeros(4, 4), **parts)
    with pytest.raises(dvp.DvpError, match="target of item 1"):
        dvp.torch.loss(torch.stack([torch.zeros(3, *SIZE), torch.full((3, *SIZE), torch.inf)]).double(), **parts)


def test_no_object_is_a_background() -> None:
    empty = dict(efd=torch.zeros(0, 1, 4), color=torch.zeros(0, 3), background=torch.tensor([0.1, 0.2, 0.3]))
    image = dvp.torch.render(**empty, size=(2, 2))
    assert torch.equal(image, empty["background"][:, None, None].expand(3, 2, 2))


def test_jax_has_the_same_images_and_gradients() -> None:
    jax = pytest.importorskip("jax")
    import dvp.jax

    parts = scene(2, dtype=torch.float32)
    arrays = {name: jax.numpy.asarray(part.detach().numpy()) for name, part in parts.items()}
    image = dvp.torch.render(**parts, size=SIZE, edge=1.5)
    render = jax.jit(lambda given: dvp.jax.render(**given, size=SIZE, edge=1.5))
    assert np.allclose(render(arrays), image.detach().numpy(), atol=1e-6)
    target = np.random.default_rng(3).uniform(0, 1, (2, 3, *SIZE)).astype(np.float32)
    for kind in ("mae", "mse"):
        wanted = dvp.torch.loss(torch.tensor(target), kind=kind, **parts).sum()
        grads = torch.autograd.grad(wanted, list(parts.values()))
        value, own = jax.jit(jax.value_and_grad(lambda given: dvp.jax.loss(target, kind=kind, **given).sum()))(arrays)
        assert np.isclose(value, wanted.item(), rtol=1e-5)
        for (name, _), grad in zip(parts.items(), grads):
            assert np.allclose(own[name], grad.numpy(), atol=1e-6), name
    pulled = jax.grad(lambda given: (render(given) * target).sum())(arrays)
    grads = torch.autograd.grad((image * torch.tensor(target)).sum(), list(parts.values()))
    for name, grad in zip(parts, grads):
        assert np.allclose(pulled[name], grad.numpy(), rtol=1e-4, atol=1e-3), name
    with pytest.raises(dvp.DvpError, match="color"):
        dvp.jax.render(**{**arrays, "color": arrays["color"][:, :1]}, size=SIZE)


def test_jax_numerical_gradients_in_f64() -> None:
    jax = pytest.importorskip("jax")
    import dvp.jax
    from jax.test_util import check_grads

    with jax.enable_x64(True):
        arrays = {name: jax.numpy.asarray(part.detach().numpy()) for name, part in scene(1).items()}
        target = jax.numpy.full((1, 3, *SIZE), 0.3)
        loss = lambda given: dvp.jax.loss(target, kind="mse", edge=1.5, **given).sum()  # noqa: E731
        check_grads(loss, (arrays,), order=1, modes=["rev"], atol=1e-5, rtol=1e-4)
