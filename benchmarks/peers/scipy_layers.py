# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Layers of one object by scipy, timed within so that starting Python does not count:
#
#   scipy_layers.py BYTES NX NY NZ M Q    one byte for each voxel, x fastest; 1: boundary
#
# Prints the seconds of the exact distance transform, and of q dilations by a ball of radius m.
import sys
import time

import numpy
from scipy import ndimage

path, (nx, ny, nz, m, q) = sys.argv[1], map(int, sys.argv[2:])
boundary = numpy.fromfile(path, numpy.uint8).reshape(nz, ny, nx) != 0

begin = time.perf_counter()
ndimage.distance_transform_edt(~boundary)
print(time.perf_counter() - begin)

z, y, x = numpy.ogrid[-m : m + 1, -m : m + 1, -m : m + 1]
ball = x * x + y * y + z * z <= m * m
begin = time.perf_counter()
layer = boundary
for _ in range(q):
    layer = ndimage.binary_dilation(layer, ball)
print(time.perf_counter() - begin)
