// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Triangles with shared vertices: what every file becomes, and what voxels are made from.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vicinity/geometry/vec3.h"

namespace vicinity {

/// Indexed triangle mesh. Vertices that are equal to the last bit are stored once. Coordinates are
/// in the file's own unit until place() puts the mesh into the workspace, in metres.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside

  /// Smallest box around all vertices that a triangle uses; empty for no triangle.
  Box bounds() const;
};

}  // namespace vicinity
