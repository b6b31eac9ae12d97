// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "demo/scene_folder.h"

#include <sstream>
#include <system_error>
#include <utility>
#include <variant>

#include "fresh_file.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/placement.h"
#include "vicinity/mesh/stl_file.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::cli {
namespace {

constexpr std::string_view name_key = "  - name: ", primitive_key = "    primitive: ";

std::string with_mesh_files(std::string_view text) {
  std::istringstream lines{std::string(text)};
  std::string changed, name;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(name_key)) name = line.substr(name_key.size());
    if (line.starts_with(primitive_key)) {
      line = "    mesh: meshes/" + name + ".stl\n    units: mm";
    }
    changed += line + '\n';
  }
  return changed;
}

}  // namespace

std::vector<std::filesystem::path> write_scene_folder(std::string_view text,
                                                      const std::filesystem::path& folder) {
  const auto meshes = folder / "meshes";
  std::error_code error;
  std::filesystem::create_directories(meshes, error);
  if (error) {
    throw Error({.where = meshes.string(),
                 .what = "cannot be made",
                 .found = error.message(),
                 .hint = "another folder with -o"});
  }
  std::vector<std::filesystem::path> files;
  Scene scene = parse_scene(text, folder, "the demo's scene");
  for (SceneObject& object : scene.objects) {
    files.push_back(meshes / (object.name + ".stl"));
    const double millimetres = 1 / metres_per(LengthUnit::millimetre);
    const WhileWriting finish_first;
    write_stl(place(std::get<TriangleMesh>(std::move(object.shape)), millimetres, Pose::Identity()),
              files.back());
  }
  FreshFile file(folder / "scene.yaml");
  file.write(with_mesh_files(text));
  file.commit();
  return files;
}

}  // namespace vicinity::cli
