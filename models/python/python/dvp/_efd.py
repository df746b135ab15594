"""Elliptic Fourier descriptors of contours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _dvp
from ._dvp import DvpError


def efd(
    contours: npt.ArrayLike | Sequence[npt.ArrayLike], harmonics: int = 20, *, normalize: bool = True
) -> npt.NDArray[np.float64]:
    """Elliptic Fourier descriptors of closed contours: harmonics x 4 of one (points x 2), contours x harmonics x 4 of a list.

    *Conventions*. Row n - 1 holds (a_n, b_n, c_n, d_n) of x(t) = sum a_n cos 2 pi n t + b_n sin 2 pi n t and
    y(t) = sum c_n cos 2 pi n t + d_n sin 2 pi n t, t the share of the contour's length from its first point. The last point may repeat
    the first. They are those of pyefd's ``elliptic_fourier_descriptors(contour, order, normalize=False)`` for contours whose last point
    repeats the first (pyefd leaves the closing edge out of others); an, bn, cn, dn of Momocs' ``efourier`` are the columns.
    The center is not among them: :func:`efd_center`.

    ``normalize`` takes position, size, angle and starting point out by the ellipse of the first harmonic, as pyefd's ``normalize_efd``
    and Momocs' ``efourier_norm`` do: a_1 = 1, b_1 = c_1 = 0, abs(d_1) <= 1. That leaves two starting points, the ends of the long
    axis; the one that lies farther from the center is taken, so that the contour's first point does not matter. pyefd and Momocs
    leave it to the first point: their rows of even n may have the other sign, and pyefd's a_1 may be -1, with all signs changed.
    Contours that turn the other way have a negative d_1 (pyefd turns them round).

    Raises :class:`DvpError` for fewer than three distinct points, numbers that are not finite or no size to normalize by.

    >>> import dvp, numpy
    >>> square = numpy.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    >>> dvp.efd(square, 1, normalize=False).round(3)
    array([[-0.405,  0.405, -0.405, -0.405]])
    """
    if not 1 <= harmonics <= 1024:
        raise DvpError(f"{harmonics} harmonics: must be 1 to 1024")
    if _is_one(contours):
        return _dvp.efd(_points(contours, ""), harmonics, normalize)[0]
    rows = []
    for k, contour in enumerate(_listed(contours)):
        points = _points(contour, f"contour {k}: ")
        try:
            rows.append(_dvp.efd(points, harmonics, normalize)[0])
        except DvpError as error:
            raise DvpError(f"contour {k}: {error}") from error
    return np.stack(rows) if rows else np.empty((0, harmonics, 4))


def efd_center(contour: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """The mean position along a closed contour (points x 2), weighted by length: the terms of n = 0 (A_0 and C_0 of Kuhl and Giardina,
    pyefd's ``calculate_dc_coefficients``)."""
    return _dvp.efd(_points(contour, ""), 1, False)[1]


def _is_one(contours: Any) -> bool:
    try:
        return np.ndim(contours) == 2
    except ValueError:
        return False


def _listed(contours: Any) -> list[Any]:
    try:
        return list(contours)
    except TypeError as error:
        raise DvpError(f"contours of type {type(contours).__name__}: must be points x 2, or a list of such") from error


def _points(contour: Any, where: str) -> npt.NDArray[np.float64]:
    try:
        points = np.ascontiguousarray(contour, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise DvpError(f"{where}no array of numbers: {error}") from error
    if points.ndim != 2 or points.shape[1] != 2:
        raise DvpError(f"{where}an array of shape {points.shape}, must be points x 2")
    return points
