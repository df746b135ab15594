"""Fits circles to an image through the renderer, in PyTorch: python examples/fit_image_torch.py [picture.png]"""

import sys

import torch

import dvp
import dvp.torch


def target() -> torch.Tensor:
    """A picture from disk, or a random scene; 3 x height x width."""
    if len(sys.argv) > 1:
        from PIL import Image
        from numpy import asarray

        return torch.tensor(asarray(Image.open(sys.argv[1]).convert("RGB"))).permute(2, 0, 1) / 255
    return torch.tensor(dvp.generate(seed=5)[0].render()).permute(2, 0, 1) / 255


def main(objects: int = 6, harmonics: int = 6, steps: int = 300) -> tuple[float, float]:
    torch.manual_seed(1)
    picture = target()
    size = (picture.shape[1], picture.shape[2])
    efd = torch.zeros(objects, harmonics, 4)
    efd[:, 0] = torch.tensor([1.0, 0.0, 0.0, 1.0])
    efd.requires_grad_()
    translation = (0.2 + 0.6 * torch.rand(objects, 2)).requires_grad_()
    log_scale = torch.full((objects,), -2.0, requires_grad=True)
    color, background = torch.zeros(objects, 3, requires_grad=True), torch.zeros(3, requires_grad=True)
    optimizer = torch.optim.Adam([efd, translation, log_scale, color, background], lr=0.02)
    losses = []
    for step in range(steps):
        place = dict(translation=translation, scale=log_scale.exp(), color=color.sigmoid(), background=background.sigmoid())
        # Soft edges see far at first, sharp ones see well at last.
        loss = dvp.torch.loss(picture, efd=efd, **place, edge=max(0.5, 8 * (1 - step / steps)))
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        losses.append(loss.item())
    print(f"{objects} objects, {size[1]} x {size[0]} pixels: mean absolute error {losses[0]:.4f}, then {losses[-1]:.4f}")
    return losses[0], losses[-1]


if __name__ == "__main__":
    main()
