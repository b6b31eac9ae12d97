// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "guarded_import.h"
#include "mesh_error.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/stl_file.h"

namespace vicinity {
namespace {

constexpr std::array<std::string_view, 7> imported = {".obj", ".ply", ".gltf", ".glb",
                                                      ".dae", ".3mf", ".fbx"};
constexpr std::array<std::string_view, 8> from_cad = {".step", ".stp", ".iges",   ".igs",
                                                      ".brep", ".x_t", ".sldprt", ".ipt"};

bool holds(const auto& kinds, const std::string& extension) {
  return std::find(kinds.begin(), kinds.end(), extension) != kinds.end();
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  const std::size_t size = readable_size(path);
  if (extension == ".stl") return read_stl(path);
  if (holds(imported, extension)) {
    TriangleMesh mesh = guarded_import(path, extension, size);
    if (mesh.triangles.empty()) throw_no_triangle(path);
    return mesh;
  }
  const bool solid_model = holds(from_cad, extension);
  throw Error(
      {.where = path.string(),
       .what = solid_model ? "a solid model holds curved surfaces, not triangles"
                           : "not a kind of mesh that is read",
       .found = extension.empty() ? "no extension" : "\"" + extension + "\"",
       .expected = "STL, OBJ, PLY, glTF, GLB, DAE, 3MF or FBX",
       .hint = solid_model ? "exporting STL from the CAD program" : "exporting the mesh as STL"});
}

}  // namespace vicinity
