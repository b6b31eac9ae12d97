// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Meshes with no more triangles than a page draws smoothly.
#pragma once

#include <cstddef>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity::viewer {

/// The same mesh where it has no more triangles than that. Else vertices that share a cell of a
/// grid become one, at their mean; the grid is as fine as the limit allows. For looking at only.
TriangleMesh simplified(const TriangleMesh& mesh, std::size_t most_triangles);

}  // namespace vicinity::viewer
