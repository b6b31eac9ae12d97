// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "named_scenes.h"

#include <cstdlib>
#include <filesystem>
#include <map>

#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::benchmarks {
namespace {

NamedObject named_object(const std::string& name, TriangleMesh mesh, int voxels) {
  constexpr int margin = layers_m * layers_q + 1;
  const Box bounds = mesh.bounds();
  const double h = bounds.sizes().maxCoeff() / (voxels - 2 * margin);
  const Box grown(bounds.min() - Vec3::Constant(margin * h),
                  bounds.max() + Vec3::Constant(margin * h));
  return {name + "_" + std::to_string(voxels), std::move(mesh), Workspace::covering(grown, h)};
}

}  // namespace

const std::vector<NamedObject>& named_objects(int voxels) {
  static std::map<int, std::vector<NamedObject>> made;
  std::vector<NamedObject>& objects = made[voxels];
  if (!objects.empty()) return objects;
  objects.push_back(named_object("torus", primitive::torus(0.3, 0.1, 256), voxels));
  if (const char* data = std::getenv("VICINITY_DATA")) {
    const std::filesystem::path clean = std::filesystem::path(data) / "meshes" / "clean";
    for (const auto& [name, file] :
         {std::pair{"statue", "Plato.stl"}, {"cad_part", "complex_bin.stl"}}) {
      if (exists(clean / file))
        objects.push_back(named_object(name, read_mesh(clean / file), voxels));
    }
  }
  return objects;
}

Scene hot_cell() { return read_scene(std::filesystem::path(VICINITY_SCENES) / "hot_cell.yaml"); }

}  // namespace vicinity::benchmarks
