# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""A field as an array: one plane of it as a picture, with nothing but numpy; and all of it as .npy.

04_slice_picture.py [FOLDER]
"""

import pathlib
import sys

import numpy as np

import vicinity

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
cone = vicinity.SceneObject("cone", vicinity.primitive.cone(0.1, 0.2))
field = vicinity.build_field(vicinity.Scene([cone], voxel_size=0.002)).field

ranks = field.voxels()  # (nx, ny, nz): boundary 0, ranks 1..q, empty -1, inner -2
plane = ranks[:, ranks.shape[1] // 2, ::-1].T  # x to the right, z up

colours = np.full((field.objects[0].q + 3, 3), 255, np.uint8)  # by value; -1 and -2 from the end
colours[0] = (40, 40, 40)
colours[-2] = (120, 120, 120)
shade = np.linspace(0, 1, field.objects[0].q)[:, None]
colours[1:-2] = (1 - shade) * (200, 60, 30) + shade * (250, 230, 190)
picture = colours[plane]
height, width = plane.shape
(folder / "slice.ppm").write_bytes(b"P6 %d %d 255\n" % (width, height) + picture.tobytes())

vicinity.export_field(field, folder / "ranks.npy")
assert np.array_equal(np.load(folder / "ranks.npy"), ranks)
print(f"slice.ppm: {width} x {height}; ranks.npy: {' x '.join(map(str, ranks.shape))}")
