# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""Builds the field of an upright vessel, and asks it for a million points at once."""

import time

import numpy as np

import vicinity

vessel = vicinity.SceneObject("vessel", vicinity.primitive.cylinder(0.2, 1.2))
field = vicinity.build_field(vicinity.Scene([vessel], voxel_size=0.005)).field

points = np.random.default_rng(1).uniform(-0.5, 0.5, (1_000_000, 3))
start = time.perf_counter()
found = field.query(points)
seconds = time.perf_counter() - start

in_layers = found.kind == vicinity.VoxelKind.neighbour
print(f"{len(points)} points in {1e3 * seconds:.0f} ms, {np.count_nonzero(in_layers)} in layers")
for rank in range(1, 7):
    r = np.hypot(*points[in_layers & (found.rank == rank)][:, :2].T)
    print(f"rank {rank}: up to {1e3 * (r.max() - 0.2):.0f} mm from the side")
