// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0
//
// A scene in memory -> files that anybody's program can read.

#include <fmt/format.h>

#include <fstream>
#include <variant>

#include "plant_room/plant_room.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/stl_file.h"

namespace vicinity::benchmarks {

void write_scene(const Scene& scene, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "meshes");
  std::string yaml = fmt::format("voxel_size: {}\n", scene.voxel_size);
  if (scene.bounds) {
    const Vec3 &lo = scene.bounds->min(), &hi = scene.bounds->max();
    yaml += fmt::format("bounds: [[{}, {}, {}], [{}, {}, {}]]\n", lo.x(), lo.y(), lo.z(), hi.x(),
                        hi.y(), hi.z());
  }
  yaml += "objects:\n";
  for (const SceneObject& object : scene.objects) {
    const std::string file = fmt::format("meshes/{}.stl", object.name);
    write_stl(std::get<TriangleMesh>(object.shape), folder / file);
    yaml += fmt::format("  - {{name: {}, mesh: {}, units: m}}\n", object.name, file);
  }
  std::ofstream out(folder / "scene.yaml");
  out << yaml;
  if (!out.flush())
    throw Error({.where = (folder / "scene.yaml").string(), .what = "cannot be written"});
}

}  // namespace vicinity::benchmarks
