// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/npy_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "geometry/file_beside.h"

namespace vicinity {
namespace {

// Format version 1.0: magic, version, length of what follows, a Python dictionary padded with
// blanks so that the data starts at a multiple of 64.
std::string header(const VoxelBox& box, VoxelQuantity quantity) {
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}, {}), }}",
                  size_of(quantity) == 2 ? "<i2" : "<f4", box.hi.i - box.lo.i, box.hi.j - box.lo.j,
                  box.hi.k - box.lo.k);
  constexpr std::size_t before = 10;
  const std::size_t padded = (before + dictionary.size() + 1 + 63) / 64 * 64 - before;
  dictionary.resize(padded - 1, ' ');
  dictionary += '\n';
  std::string text("\x93NUMPY\x01\x00", 8);
  text += static_cast<char>(padded & 0xff);
  text += static_cast<char>(padded >> 8);
  return text + dictionary;
}

std::string description(const ViscosityField& field, const VoxelBox& box, VoxelQuantity quantity) {
  const Workspace& grid = field.workspace();
  const Vec3 origin = grid.origin + grid.voxel_size * Vec3(box.lo.i, box.lo.j, box.lo.k);
  nlohmann::ordered_json json = {
      {"what", to_string(quantity)},
      {"origin", {origin.x(), origin.y(), origin.z()}},
      {"voxel_size", grid.voxel_size},
      {"dims", {box.hi.i - box.lo.i, box.hi.j - box.lo.j, box.hi.k - box.lo.k}},
  };
  if (quantity == VoxelQuantity::rank) {
    json["values"] = {{"boundary", 0}, {"empty", -1}, {"inner", -2}};
  }
  if (quantity == VoxelQuantity::object) {
    json["objects"] = nlohmann::ordered_json::array();
    for (const FieldObject& object : field.objects()) json["objects"].push_back(object.name);
  }
  return json.dump(2) + '\n';
}

}  // namespace

void write_npy(const ViscosityField& field, const VoxelBox& box, VoxelQuantity quantity,
               const std::filesystem::path& path, const std::function<void(double)>& progress) {
  FileBeside array(path);
  FileBeside beside(std::filesystem::path(path).replace_extension(".json"));
  array.write(header(box, quantity));
  VoxelPlanes planes(field, box, quantity, Fastest::z);
  for (std::int32_t i = 0; i < planes.count(); ++i) {
    array.write(planes.plane(i));
    progress(static_cast<double>(i + 1) / planes.count());
  }
  beside.write(description(field, box, quantity));
  beside.move_into_place();
  array.move_into_place();
}

}  // namespace vicinity
