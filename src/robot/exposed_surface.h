// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The part of a link's surface that anything can come near.
#pragma once

#include <vector>

#include "surface_samples.h"

namespace vicinity {

/// CAD models of arms hold motors, gears and inner walls, which would double the surface and so the
/// drag. Leaves out the triangles that nothing from outside can reach: the space outside is filled,
/// voxel by voxel, as far as it gets without passing a surface.
///
/// Voxels are 1 mm, or larger on links of more than 8 litres or 2 m. A triangle stays if any point
/// of it is within two voxels of the space outside, so that a wall thinner than about 3 mm keeps
/// both its sides. The outside gets in through holes and slits wider than about three voxels; what
/// lies behind narrower ones counts as inside. Does not depend on the order of the triangles.
std::vector<Corners> exposed_surface(std::vector<Corners> triangles);

}  // namespace vicinity
