"""Fits outlines to an image through the renderer, in PyTorch: python examples/fit_image_torch.py [picture.png]"""

import sys

import numpy as np
import torch

import dvp
import dvp.torch


def main(objects: int = 6, harmonics: int = 6, steps: int = 300) -> tuple[float, float]:
    torch.manual_seed(1)
    if len(sys.argv) > 1:
        from PIL import Image

        pixels = np.asarray(Image.open(sys.argv[1]).convert("RGB"))
    else:
        pixels = dvp.generate(seed=5)[0].render()
    picture = torch.tensor(pixels).permute(2, 0, 1) / 255
    efd = torch.zeros(objects, harmonics, 4)
    efd[:, 0] = torch.tensor([1.0, 0.0, 0.0, 1.0])  # circles
    translation, log_scale = 0.2 + 0.6 * torch.rand(objects, 2), torch.full((objects,), -2.0)
    numbers = [efd, translation, log_scale, torch.zeros(objects, 3), torch.zeros(3)]
    efd, translation, log_scale, color, background = (tensor.requires_grad_() for tensor in numbers)
    optimizer = torch.optim.Adam(numbers, lr=0.02)
    losses = []
    for step in range(steps):
        place = dict(translation=translation, scale=log_scale.exp(), color=color.sigmoid(), background=background.sigmoid())
        # Soft edges see far at first, sharp ones see well at last; a few softnesses, as each is a layout of its own.
        loss = dvp.torch.loss(picture, efd=efd, **place, edge=8.0 / 2 ** (5 * step // steps))
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        losses.append(loss.item())
    print(f"{objects} objects: mean absolute error {losses[0]:.4f}, then {losses[-1]:.4f}")
    return losses[0], losses[-1]


if __name__ == "__main__":
    main()
