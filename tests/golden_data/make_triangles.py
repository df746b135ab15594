"""Writes triangles.json: one object of the reference's fixtures with its ear-cut faces and some of its coverages.

Usage: python3 make_triangles.py FIXTURES > triangles.json
where FIXTURES holds a_geometry.json and a_target_object_prob.npy, made with the unmodified reference renderer
(PyTorch3D 0.7.5, CPU, f32). Needs nothing but Python.
"""

import ast
import json
import struct
import sys

folder = sys.argv[1]
with open(f"{folder}/a_geometry.json") as file:
    scene = json.load(file)[0]
vertices, faces = scene["verts_ndc"], scene["faces"]
if len(vertices) == 1:
    vertices, faces = vertices[0], faces[0] if len(faces) == 1 else faces

with open(f"{folder}/a_target_object_prob.npy", "rb") as file:
    assert file.read(8) == b"\x93NUMPY\x01\x00"
    (length,) = struct.unpack("<H", file.read(2))
    header = ast.literal_eval(file.read(length).decode())
    assert header["descr"] == "<f4" and not header["fortran_order"] and header["shape"][1:] == (128, 128, 4)
    plane = struct.unpack("<" + "f" * (128 * 128 * 4), file.read(128 * 128 * 4 * 4))

# The first object: vertices 0 to 63, y turned down again.
outline = [[x, -y] for x, y, _ in vertices[:64]]
own = [face for face in faces if max(face) < 64]
samples = []
for row in range(1, 128, 5):
    for column in range(128):
        p = plane[(row * 128 + column) * 4]
        # The soft border, the seams, and a few pixels well inside or outside.
        if 0 < p < 0.9999 or (row + column) % 37 == 0:
            samples.append([row, column, float(f"{p:.7g}")])

json.dump({"outline": outline, "faces": own, "coverage": samples}, sys.stdout, separators=(",", ":"))
print()
