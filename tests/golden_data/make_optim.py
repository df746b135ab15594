"""Writes optim.json: PyTorch's Adam on a small function, and its ReduceLROnPlateau on a small sequence of losses.

Run with torch (any CPU build; 1.13 made the file that is here): python3 make_optim.py
"""

import json
import pathlib

import torch

# Adam: f(p) = sum w (p - q)^2 / 2 + sum cos(3 p), whose gradient is w (p - q) - 3 sin(3 p); one weight is tiny, so that
# epsilon shows.
START = [0.5, -1.25, 2.0, 0.3]
TARGET = [0.1, 0.4, -0.7, 0.3000001]
WEIGHT = [1.0, 0.01, 30.0, 1e-6]
WAVE = [1.0, 0.5, 1.0, 0.0]
STEPS = [1, 2, 3, 10, 50, 100]

parameters = torch.tensor(START, dtype=torch.float64, requires_grad=True)
target, weight, wave = (torch.tensor(v, dtype=torch.float64) for v in (TARGET, WEIGHT, WAVE))
adam = torch.optim.Adam([parameters], lr=0.01)
path = []
for step in range(1, max(STEPS) + 1):
    adam.zero_grad()
    loss = (weight * (parameters - target) ** 2 / 2 + wave * torch.cos(3 * parameters)).sum()
    loss.backward()
    adam.step()
    if step in STEPS:
        path.append({"step": step, "parameters": parameters.tolist()})

# Plateau: falls, stays, falls by less than the threshold, falls again, stays for long.
losses = [1 / (1 + k) for k in range(8)]
losses += [losses[-1]] * 14
losses += [losses[-1] * (1 - 5e-5 * k) for k in range(1, 16)]
losses += [0.05, 0.04, 0.0399999, 0.03]
losses += [0.03 + 0.001 * (k % 3) for k in range(60)]
dummy = torch.zeros(1, requires_grad=True)
optimizer = torch.optim.SGD([dummy], lr=0.01)
schedule = torch.optim.lr_scheduler.ReduceLROnPlateau(optimizer, patience=10, cooldown=10, factor=0.5)
rates = []
for loss in losses:
    schedule.step(loss)
    rates.append(optimizer.param_groups[0]["lr"])

out = {
    "adam": {"start": START, "target": TARGET, "weight": WEIGHT, "wave": WAVE, "learning_rate": 0.01, "path": path},
    "plateau": {"learning_rate": 0.01, "losses": losses, "rates": rates},
}
pathlib.Path(__file__).with_name("optim.json").write_text(json.dumps(out, indent=1) + "\n")
