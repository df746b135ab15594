"""A renderer of the paper's kind: soft polygons in tensor operations, every pixel against every edge, gradients by autograd."""

from __future__ import annotations

import torch


def outlines(parts: dict[str, torch.Tensor], vertices: int = 64) -> torch.Tensor:
    """Posed outlines of descriptors: objects x vertices x 2, scene units."""
    efd = parts["efd"]
    n = torch.arange(1, efd.shape[-2] + 1, dtype=efd.dtype)
    angle = 2 * torch.pi * n[:, None] * torch.linspace(0, 1, vertices, dtype=efd.dtype)
    cos, sin = angle.cos(), angle.sin()
    x = torch.einsum("kn,nv->kv", efd[..., 0], cos) + torch.einsum("kn,nv->kv", efd[..., 1], sin)
    y = torch.einsum("kn,nv->kv", efd[..., 2], cos) + torch.einsum("kn,nv->kv", efd[..., 3], sin)
    c, s = parts["rotation"].cos()[:, None], parts["rotation"].sin()[:, None]
    turned = torch.stack([c * x - s * y, s * x + c * y], dim=2)
    return parts["scale"][:, None, None] * turned + parts["translation"][:, None, :]


def signed_distance(outline: torch.Tensor, side: int) -> torch.Tensor:
    """Distance of every pixel center to every outline, px, negative inside: objects x pixels."""
    center = (torch.arange(side, dtype=outline.dtype) + 0.5) / side
    y, x = torch.meshgrid(center, center, indexing="ij")
    pixel = torch.stack([x.reshape(-1), y.reshape(-1)], dim=1)[None, :, None, :]
    start = outline[:, None, :, :]
    end = outline.roll(-1, dims=1)[:, None, :, :]
    edge, to = end - start, pixel - start
    length = (edge * edge).sum(-1).clamp_min(1e-12)
    along = ((to * edge).sum(-1) / length).clamp(0, 1)
    apart = to - along[..., None] * edge
    distance = ((apart * apart).sum(-1).min(dim=2).values + 1e-12).sqrt() * side
    with torch.no_grad():
        straddles = (start[..., 1] > pixel[..., 1]) != (end[..., 1] > pixel[..., 1])
        rise = torch.where(edge[..., 1] == 0, torch.ones_like(edge[..., 1]), edge[..., 1])
        crossing = start[..., 0] + (pixel[..., 1] - start[..., 1]) / rise * edge[..., 0]
        inside = (straddles & (pixel[..., 0] < crossing)).sum(dim=2) % 2 == 1
    return torch.where(inside, -distance, distance)


def render(parts: dict[str, torch.Tensor], side: int, sigma_px: float) -> torch.Tensor:
    """One scene, later objects over earlier ones: 3 x side x side."""
    coverage = torch.sigmoid(-signed_distance(outlines(parts), side) / sigma_px)
    image = parts["background"][:, None].expand(3, side * side)
    for k in range(coverage.shape[0]):
        image = image * (1 - coverage[k]) + parts["color"][k][:, None] * coverage[k]
    return image.reshape(3, side, side)


def render_batch(parts: dict[str, torch.Tensor], side: int, sigma_px: float) -> torch.Tensor:
    """Scene by scene: all at once would take gigabytes."""
    batch = parts["efd"].shape[0]
    shared = ("background",)
    one = [{name: part if name in shared else part[b] for name, part in parts.items()} for b in range(batch)]
    return torch.stack([render(scene, side, sigma_px) for scene in one])
