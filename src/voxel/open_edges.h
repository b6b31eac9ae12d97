// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Edges at which a mesh is open, as far as voxels can tell.
#pragma once

#include <vector>

#include "grid_mesh.h"

namespace vicinity {

/// Directed edge that `surplus` more triangles run along than run back, in grid coordinates.
struct OpenEdge {
  Vec3 from, to;
  int surplus;
};

/// Cracks so narrow do not count: seen from a voxel centre, half a voxel away or more, they leave
/// the winding number far closer to a whole number than to the next one half.
inline constexpr double crack_vox = 1e-3;

/// Open edges of a mesh, ordered by coordinates. Edges whose ends are within `crack` voxels of each
/// other cancel, as CAD exports leave them; with 0 only edges of the same vertices do, and none are
/// left just where the winding number is whole everywhere off the surface.
std::vector<OpenEdge> open_edges(const GridMesh& mesh, double crack);

}  // namespace vicinity
