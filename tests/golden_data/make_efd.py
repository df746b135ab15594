"""Writes efd.json: descriptors of three closed polygons, raw and normalized, by pyefd.

Run with numpy and pyefd 1.6.0 (1.8 forces one direction of travel and is not what the reference uses): python3 make_efd.py
"""

import json
import pathlib

import numpy as np
import pyefd

ORDER = 6


def polygon(corners, wave, turn):
    angle = 2 * np.pi * np.arange(corners) / corners
    radius = 1 + 0.3 * np.cos(wave * angle + turn) + 0.2 * np.sin(angle)
    points = np.stack([1.5 * radius * np.cos(angle + turn) + 0.3, radius * np.sin(angle + turn) - 0.2], axis=1)
    return np.round(points, 6)


cases = []
for corners, wave, turn in [(5, 2, 0.4), (9, 3, -1.0), (14, 4, 2.2)]:
    points = polygon(corners, wave, turn)
    closed = np.concatenate([points, points[:1]])
    raw = pyefd.elliptic_fourier_descriptors(closed, order=ORDER)
    normalized, transformation = pyefd.normalize_efd(raw.copy(), return_transformation=True)
    cases.append(
        {
            "contour": points.tolist(),
            "center": list(pyefd.calculate_dc_coefficients(closed)),
            "raw": raw.tolist(),
            "normalized": normalized.tolist(),
            # Scale, angle of the long axis, phase.
            "transformation": [float(value) for value in transformation],
        }
    )

text = "[\n" + ",\n".join(json.dumps(case) for case in cases) + "\n]\n"
pathlib.Path(__file__).with_name("efd.json").write_text(text)
