// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// STL files, binary and ASCII.
#pragma once

#include <cstddef>
#include <filesystem>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

/// Reads an STL file; binary or ASCII is told from the content, not from the word "solid". Several
/// solids in an ASCII file become one mesh. Stored normals are ignored: the winding says the same,
/// and real files hold zeros or nonsense there.
/// Errors: as read_mesh(); also for a binary file whose size is not what its triangle count says,
/// and for an ASCII file that does not end with "endsolid".
TriangleMesh read_stl(const std::filesystem::path& path);

/// Writes a binary STL file, beside and renamed into place. Coordinates are rounded to float.
/// A symbolic link stays one: what it leads to is replaced.
/// Errors: throws Error where the file cannot be written, and where something that is no regular
/// file is there.
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& path);

/// How many triangles of an STL file carry a normal of zero. read_stl() does not mind: it goes by
/// the winding. Programs that go by normals find no side on such triangles. Errors: throws Error
/// for a file that cannot be opened; what is no STL file has none.
std::size_t count_zero_normals(const std::filesystem::path& path);

}  // namespace vicinity
