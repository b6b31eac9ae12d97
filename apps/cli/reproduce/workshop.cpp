// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/workshop.h"

#include <system_error>

#include "interruption.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/stl_file.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity::report {
namespace {

constexpr double mm_per_m = 1000;

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw Error(
        {.where = folder.string(), .what = "the folder cannot be made", .found = error.message()});
  }
}

}  // namespace

Workshop::Workshop(std::filesystem::path folder) : folder_(std::move(folder)) {
  make_folder(folder_);
}

std::filesystem::path Workshop::file(const std::string& name) const {
  std::filesystem::path path = folder_ / name;
  make_folder(path.parent_path());
  return path;
}

std::filesystem::path Workshop::write_mesh(const Part& part) const {
  const std::filesystem::path path = file("meshes/" + part.name + ".stl");
  const cli::WhileWriting finish_first;
  write_stl(place(part.mesh, mm_per_m * voxel_m, Pose::Identity()), path);
  return path;
}

TriangleMesh Workshop::read_back(const Part& part) const {
  return place(read_mesh(write_mesh(part)), metres_per(LengthUnit::millimetre), Pose::Identity());
}

ViscosityField Workshop::field(const Part& part, const Layers& layers) const {
  SceneObject object;
  object.name = part.name;
  object.shape = MeshFile{write_mesh(part), LengthUnit::millimetre};
  object.m = layers.m;
  object.q = layers.q;
  object.layers = layers.shape;
  object.coding = layers.coding;
  object.boundary = layers.boundary;
  object.inner = layers.inner;
  Scene scene;
  scene.voxel_size = voxel_m;
  scene.bounds = Box(Vec3::Zero(), voxel_m * Vec3(part.dims.i, part.dims.j, part.dims.k));
  scene.objects = {object};
  return build_field(scene).field;
}

ViscosityField Workshop::distances(const Part& part, int reach) const {
  constexpr int m = 8;
  const int q = (reach + m - 1) / m;
  return field(part, {.m = m,
                      .q = q,
                      .shape = LayerShape::distance,
                      .coding = {std::vector<double>(static_cast<std::size_t>(q), 1.0), 1}});
}

}  // namespace vicinity::report
