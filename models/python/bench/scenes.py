"""The scenes that are measured: those of `bench/core/src/main.rs`, number for number."""

from __future__ import annotations

import numpy as np
import torch

SIDE, SCENES, OBJECTS, HARMONICS = 128, 32, 4, 16


def scenes() -> dict[str, torch.Tensor]:
    """Wobbly disks around the middle, float32, with gradients: scenes x objects x ..."""
    at = np.arange(SCENES * OBJECTS, dtype=np.float64)[:, None]
    n = np.arange(1, HARMONICS + 1, dtype=np.float64)[None, :]
    wave = np.stack([np.cos(at + n), np.sin(at * n), np.sin(2 * at + n), np.cos(at - n)], axis=2)
    efd = 0.1 / (n**2)[..., None] * wave
    efd[:, 0] += (1, 0, 0, 1)
    at = at[:, 0]
    parts = dict(
        efd=efd,
        translation=np.stack([0.5 + 0.25 * np.cos(1.7 * at), 0.5 + 0.25 * np.sin(2.3 * at)], axis=1),
        scale=0.15 + 0.1 * np.abs(np.sin(0.9 * at)),
        rotation=at,
        color=np.stack([0.5 + 0.5 * np.sin(at + c) for c in range(3)], axis=1),
    )
    tensors = {
        name: torch.tensor(part.reshape(SCENES, OBJECTS, *part.shape[1:]), dtype=torch.float32, requires_grad=True)
        for name, part in parts.items()
    }
    tensors["background"] = torch.full((3,), 0.5, requires_grad=True)
    return tensors
