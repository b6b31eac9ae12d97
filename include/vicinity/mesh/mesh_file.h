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
/// applied, its up axis is not turned, and a unit that it states (DAE, 3MF, FBX) is not multiplied
/// in, because the scene states the unit. Equal vertices are joined. A mesh may come back broken
/// (open, degenerate, non-manifold): inspect() says so.
///
/// STL is read here, ASCII numbers in double precision. The other kinds are read by assimp, as
/// float, in a child process that may take 2 s of CPU time plus 1 s for each MB of the file, and
/// 512 MiB of memory plus 64 bytes for each byte: what their bytes do to assimp cannot reach this
/// process. An STL cut anywhere is refused; a text format without an end mark (OBJ) cannot be.
///
/// Errors: throws Error, without large allocations and whatever the bytes are, for a file that
/// cannot be opened, is of no known kind, is cut short, lies about its triangle count, holds no
/// triangle, has a coordinate that is not finite or beyond 1e9 units, or is beyond those limits.
TriangleMesh read_mesh(const std::filesystem::path& path);

}  // namespace vicinity
