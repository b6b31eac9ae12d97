// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Reading any mesh file the project knows.
#pragma once

#include <filesystem>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

/// Reads STL, OBJ, PLY, glTF, GLB, DAE, 3MF or FBX, chosen by the file's extension in any case.
///
/// Coordinates come as the file has them, in the file's unit: node transforms inside the file are
/// applied, its up axis is not turned. Equal vertices are joined. A mesh may come back broken
/// (open, degenerate, non-manifold): inspect() says so.
///
/// Errors: throws Error, without large allocations and whatever the bytes are, for a file that
/// cannot be opened, is of no known kind, is cut short, lies about its triangle count, holds no
/// triangle, or has a coordinate that is not finite or beyond 1e9 units.
TriangleMesh read_mesh(const std::filesystem::path& path);

}  // namespace vicinity
