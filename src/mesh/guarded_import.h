// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Reading the kinds of mesh file that assimp knows, without trusting assimp with this process.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

/// Imports the file in a child process that may take 2 s of CPU time plus 1 s for each MB, and
/// 512 MiB of memory plus 64 bytes for each byte of the file. assimp 5.2 aborts, faults or hangs on
/// some damaged PLY, 3MF and FBX files; in the child that costs one Error and nothing else.
///
/// Triangles come with node transforms applied, polygons cut into triangles, points and lines left
/// out, and equal vertices joined. Coordinates pass through assimp as floats.
/// @param extension  what it is: ".obj", ".ply", ".gltf", ".glb", ".dae", ".3mf" or ".fbx"
/// @param size       of the file [bytes]
/// Errors: throws Error where no mesh can be had from the file.
TriangleMesh guarded_import(const std::filesystem::path& path, std::string_view extension,
                            std::size_t size);

}  // namespace vicinity
