"""Descriptors, by the conventions of pyefd."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import dvp


def blob(rng: Any, count: int = 40) -> Any:
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    radius = 1 + 0.15 * rng.standard_normal(count) + 0.5 * np.cos(2 * angle)
    return np.stack([3 + radius * np.cos(angle), 5 + radius * np.sin(angle)], axis=1)


def test_descriptors_are_those_of_pyefd() -> None:
    pyefd = pytest.importorskip("pyefd")
    rng = np.random.default_rng(7)
    for _ in range(20):
        contour = blob(rng)
        closed = np.concatenate([contour, contour[:1]])
        expected = pyefd.elliptic_fourier_descriptors(closed, order=12)
        assert np.allclose(dvp.efd(contour, 12, normalize=False), expected, atol=1e-12)
        assert np.allclose(dvp.efd(closed, 12, normalize=False), expected, atol=1e-12)
        normal, own = pyefd.normalize_efd(expected.copy()), dvp.efd(contour, 12)
        # Which way the long axis points is open there: a_1 may be -1.
        normal = normal * np.sign(normal[0, 0])
        twin = normal * np.where(np.arange(1, 13) % 2 == 0, -1, 1)[:, None]
        assert np.allclose(own, normal, atol=1e-9) or np.allclose(own, twin, atol=1e-9)
        center = pyefd.calculate_dc_coefficients(closed)
        assert np.allclose(dvp.efd_center(contour), center, atol=1e-12)


def test_normal_forms_forget_place_size_angle_and_start() -> None:
    rng = np.random.default_rng(8)
    for _ in range(20):
        contour = blob(rng)
        own = dvp.efd(contour, 10)
        angle = rng.uniform(0, 6)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        moved = np.roll(contour, rng.integers(40), axis=0) @ turn.T * rng.uniform(0.1, 9) + rng.uniform(-9, 9, 2)
        assert np.allclose(dvp.efd(moved, 10), own, atol=1e-9)
        assert np.allclose(own[0, :3], [1, 0, 0], atol=1e-12) and 0 < own[0, 3] <= 1
        # The other way round is the mirror image in time.
        assert dvp.efd(contour[::-1], 10)[0, 3] < 0


def test_lists_and_scenes(square: Any) -> None:
    rng = np.random.default_rng(9)
    contours = [blob(rng), blob(rng, 30)]
    both = dvp.efd(contours, 5)
    assert both.shape == (2, 5, 4) and np.array_equal(both[1], dvp.efd(contours[1], 5))
    assert dvp.efd([], 5).shape == (0, 5, 4)
    scene = dvp.fit(square)
    assert scene.efd(6).shape == (1, 6, 4)
    ((ring,),) = scene.outlines()
    assert np.allclose(scene.efd(6), dvp.efd([ring], 6), atol=1e-9)
    assert np.allclose(scene.efd(6, normalize=False), dvp.efd([ring], 6, normalize=False), atol=1e-9)
