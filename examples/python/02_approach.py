# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The drag on a tool that comes near a vessel, and goes away again."""

import numpy as np

import vicinity

vessel = vicinity.SceneObject("vessel", vicinity.primitive.cylinder(0.2, 1.2))
field = vicinity.build_field(vicinity.Scene([vessel])).field

# To within 20 mm of its side and back, in two seconds: slower and slower, then turning round.
t = np.arange(0, 2, 1e-3)
path_W = np.zeros((len(t), 3))
path_W[:, 0] = 0.22 + 0.15 * np.cos(np.pi * t / 2) ** 2

for direction in (vicinity.DragDirection.all, vicinity.DragDirection.closing):
    felt = vicinity.trace(field, path_W, area=4e-4, memory="rising", direction=direction)
    drag = np.linalg.norm(felt.force_W, axis=1)
    coming, going = drag[t < 1].max(), drag[t > 1].max()
    print(f"{direction.name:8} at most {1e3 * coming:.2f} mN on the way in, {1e3 * going:.2f} out")
