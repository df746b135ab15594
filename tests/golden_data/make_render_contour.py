"""Writes render_contour.json: one scene of the reference's fixtures, some of its pixels, and the gradients toward a target.

Usage: python3 make_render_contour.py FIXTURES > render_contour.json
where FIXTURES holds the files a_*, made with the unmodified reference renderer (PyTorch3D 0.7.5, CPU, f32).
Needs nothing but Python.
"""

import ast
import json
import struct
import sys

folder, scene, batch = sys.argv[1], 2, 16


def read(name):
    """The values and dimensions of an .npy file of f32."""
    with open(f"{folder}/{name}.npy", "rb") as file:
        assert file.read(8) == b"\x93NUMPY\x01\x00"
        (length,) = struct.unpack("<H", file.read(2))
        header = ast.literal_eval(file.read(length).decode())
        assert header["descr"] == "<f4" and not header["fortran_order"]
        count = 1
        for n in header["shape"]:
            count *= n
        return struct.unpack(f"<{count}f", file.read(4 * count)), header["shape"]


def scene_of(name):
    with open(f"{folder}/{name}.json") as file:
        found = json.load(file)["scenes"][scene]
    for one in found["objects"]:
        while one["efd"] and not any(one["efd"][-1]):
            one["efd"].pop()
        one["efd"] = [[float(f"{v:.8g}") for v in row] for row in one["efd"]]
    return found


def gradient(name):
    values, dims = read(name)
    count = len(values) // dims[0]
    # Of the mean over one image, not over the batch.
    return [float(f"{batch * v:.6g}") for v in values[scene * count : (scene + 1) * count]]


image, _ = read("a_perturbed_image")
pixels = []
for row in range(3, 128, 7):
    for column in range(1, 128, 6):
        start = ((scene * 128 + row) * 128 + column) * 3
        pixels.append([row, column] + [float(f"{v:.6g}") for v in image[start : start + 3]])

names = "tsrcfbe"
json.dump(
    {
        "scene": scene_of("a_perturbed_scenes"),
        "target": scene_of("a_target_scenes"),
        "pixels": pixels,
        "mae": [gradient(f"a_grad_{name}") for name in names],
        "mse": [gradient(f"a_gradmse_{name}") for name in names],
    },
    sys.stdout,
    separators=(",", ":"),
)
print()
