"""dvp.torch beside the core alone and beside soft polygons in tensor operations: times and gradients.

Run: `RAYON_NUM_THREADS=1 python bench/render.py` with the package installed; it builds `bench/core` with cargo. One thread everywhere.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

os.environ.setdefault("RAYON_NUM_THREADS", "1")

import torch  # noqa: E402

import dvp.torch  # noqa: E402
import soft_polygons  # noqa: E402
from scenes import SCENES, SIDE, scenes  # noqa: E402

RUNS = 41
#: Softness of edges where the two renderers are compared, px.
SIGMA_PX = 1.0


def least_ms(work: Callable[[], object], runs: int = RUNS) -> float:
    """The least time, for what else runs on the machine only adds; the first run makes memory and does not count."""
    work()
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        work()
        times.append((time.perf_counter() - start) * 1e3)
    return min(times)


def core() -> dict[str, float]:
    """The core's times and the mean of its images."""
    command = ["cargo", "run", "--release", "--quiet", "-p", "dvp-python-bench-core"]
    done = subprocess.run(command, cwd=Path(__file__).parent.parent, capture_output=True, text=True, check=True)
    times: dict[str, float] = json.loads(done.stdout)
    return times


def main() -> None:
    torch.set_num_threads(1)
    parts = scenes()
    numbers = list(parts.values())
    options = dict(size=(SIDE, SIDE), edge="reference", compositing="blend")
    target = torch.zeros(SCENES, 3, SIDE, SIDE)
    pull = torch.full_like(target, 1 / (3 * SIDE * SIDE))
    fixed = {name: part.detach() for name, part in parts.items()}

    def own_loss() -> object:
        losses = dvp.torch.loss(target, **parts, edge="reference", compositing="blend")
        return torch.autograd.grad(losses.sum(), numbers)

    # By turns, so that whatever slows the machine down hurts all alike.
    rounds = []
    for _ in range(10):
        rounds.append((
            core(),
            {
                "render": least_ms(lambda: dvp.torch.render(**fixed, **options)),
                "render and back": least_ms(
                    lambda: torch.autograd.grad(dvp.torch.render(**parts, **options), numbers, pull)
                ),
                "loss and gradient": least_ms(own_loss),
            },
        ))
    mean = float(dvp.torch.render(**fixed, **options).double().mean())
    assert abs(mean - rounds[0][0]["mean"]) < 1e-6, "both must paint the same"
    print(f"{SCENES} scenes of {SIDE} x {SIDE} pixels, 4 objects, 16 harmonics, 64 vertices, f32, one thread; ms per batch\n")
    print("| | core | dvp.torch | ratio |\n|---|---|---|---|")
    for name in rounds[0][1]:
        own, other = min(times[name] for times, _ in rounds), min(times[name] for _, times in rounds)
        print(f"| {name} | {own:.2f} | {other:.2f} | {other / own:.2f} |")

    if "--quick" in sys.argv:
        return
    soft = dict(size=(SIDE, SIDE), edge=SIGMA_PX, compositing="over")
    weight = torch.rand(SCENES, 3, SIDE, SIDE, generator=torch.Generator().manual_seed(1))

    def ours() -> tuple[torch.Tensor, ...]:
        return torch.autograd.grad((dvp.torch.render(**parts, **soft) * weight).sum(), numbers)

    def tensors() -> tuple[torch.Tensor, ...]:
        return torch.autograd.grad((soft_polygons.render_batch(parts, SIDE, SIGMA_PX) * weight).sum(), numbers)

    with torch.no_grad():
        image, other_image = dvp.torch.render(**fixed, **soft), soft_polygons.render_batch(fixed, SIDE, SIGMA_PX)
        times = {
            "forward": (
                least_ms(lambda: dvp.torch.render(**fixed, **soft)),
                least_ms(lambda: soft_polygons.render_batch(fixed, SIDE, SIGMA_PX), 3),
            )
        }
    times["forward and backward"] = least_ms(ours), least_ms(tensors, 3)
    print(f"\nBeside soft polygons in tensor operations of PyTorch (`soft_polygons.py`), logistic edges of {SIGMA_PX:g} px:\n")
    print("| | dvp.torch | tensor operations | times as fast |\n|---|---|---|---|")
    for name, (own, other) in times.items():
        print(f"| {name} | {own:.1f} ms | {other:.0f} ms | {other / own:.0f} |")
    print(f"\nImages differ by {float((image - other_image).abs().max()):.1g} at most. Gradients, difference over norm:")
    for name, a, b in zip(parts, ours(), tensors()):
        print(f"- {name}: {float((a - b).norm() / b.norm()):.1g}")


if __name__ == "__main__":
    main()
