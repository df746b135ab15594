"""Writes metric.json: SSIM, MAE, MSE of small random images and the adjusted Rand index of small labelings.

Run with scikit-image and scikit-learn (0.26 and 1.9 made the file that is here): python3 make_metric.py
scikit-image's Gaussian weights are torchmetrics' window: 11 pixels at sigma 1.5, borders cropped.
"""

import json
import pathlib
import random

import numpy
from skimage.metrics import structural_similarity
from sklearn.metrics import adjusted_rand_score

random.seed(5)
images = []
for width, height, noise in [(17, 13, 0.1), (11, 11, 0.5), (29, 12, 0.02)]:
    target = [round(random.random(), 3) for _ in range(3 * width * height)]
    image = [round(min(max(v + random.gauss(0, noise), 0), 1), 3) for v in target]
    a, b = (numpy.array(v).reshape(3, height, width) for v in (image, target))
    ssim = structural_similarity(
        a, b, channel_axis=0, data_range=1.0, gaussian_weights=True, sigma=1.5, use_sample_covariance=False
    )
    images.append({
        "width": width, "height": height, "image": image, "target": target,
        "ssim": float(ssim), "mae": float(abs(a - b).mean()), "mse": float(((a - b) ** 2).mean()),
    })

labelings = []
for labels, changed in [(3, 0.1), (5, 0.5), (2, 1.0)]:
    a = [random.randrange(labels) for _ in range(60)]
    b = [random.randrange(labels) if random.random() < changed else v for v in a]
    labelings.append({"a": a, "b": b, "ari": float(adjusted_rand_score(a, b))})

text = json.dumps({"images": images, "labelings": labelings}, separators=(",", ":"))
(pathlib.Path(__file__).parent / "metric.json").write_text(text + "\n")
