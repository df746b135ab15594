"""Writes metric.json: SSIM, MAE, MSE of small random images and the adjusted Rand index of small labelings.

Run with scipy and scikit-learn (1.9 made the file that is here): python3 make_metric.py
"""

import json
import pathlib
import random

import numpy
from scipy.ndimage import gaussian_filter
from sklearn.metrics import adjusted_rand_score


def structural_similarity(a, b):
    """Gaussian window of sigma 1.5 cut at 5 pixels, borders reflected without repeating the border pixel."""

    def mean(image):
        return gaussian_filter(image, sigma=(0, 1.5, 1.5), radius=(0, 5, 5), mode="mirror")

    m_a, m_b = mean(a), mean(b)
    v_a, v_b, cov = mean(a * a) - m_a**2, mean(b * b) - m_b**2, mean(a * b) - m_a * m_b
    return ((2 * m_a * m_b + 1e-4) * (2 * cov + 9e-4) / ((m_a**2 + m_b**2 + 1e-4) * (v_a + v_b + 9e-4))).mean()


random.seed(5)
images = []
for width, height, noise in [(17, 13, 0.1), (11, 11, 0.5), (29, 12, 0.02)]:
    target = [round(random.random(), 3) for _ in range(3 * width * height)]
    image = [round(min(max(v + random.gauss(0, noise), 0), 1), 3) for v in target]
    a, b = (numpy.array(v).reshape(3, height, width) for v in (image, target))
    ssim = structural_similarity(a, b)
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
