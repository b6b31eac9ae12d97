// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "pick.h"

#include "vicinity/layers/shaping_element.h"

namespace vicinity::viewer {
namespace {

using Json = nlohmann::ordered_json;

// No nearer to the object than that [m].
Json at_least(const ViscosityField& field, const FieldSample& sample) {
  if (sample.distance_m >= 0) return sample.distance_m;
  switch (sample.record.kind) {
    case VoxelKind::empty:
      return nullptr;
    case VoxelKind::inner:
    case VoxelKind::boundary:
      return 0.0;
    case VoxelKind::neighbour:
      break;
  }
  const FieldObject& object = field.objects()[sample.record.object];
  return nearest_by_rank_vox(object.layers, object.m, object.q)[sample.record.rank - 1u] *
         field.workspace().voxel_size;
}

}  // namespace

Json pick_json(const ViscosityField& field, const Vec3& p_W) {
  const FieldSample sample = field.at(p_W);
  const Workspace& workspace = field.workspace();
  const Vec3 grid = workspace.to_grid(p_W);
  const Vec3 dims(workspace.dims.i, workspace.dims.j, workspace.dims.k);
  const bool inside = (grid.array() >= 0).all() && (grid.array() < dims.array()).all();
  Json json{
      {"point", {p_W.x(), p_W.y(), p_W.z()}}, {"voxel", nullptr}, {"inside", inside}, {"code", 0}};
  if (inside) {
    const VoxelIndex v = workspace.index_of(p_W);
    json["voxel"] = {v.i, v.j, v.k};
    json["code"] = field.code_at(v);
  }
  const bool empty = sample.record.kind == VoxelKind::empty;
  json["kind"] = to_string(sample.record.kind);
  json["object"] = empty ? Json() : Json(field.objects()[sample.record.object].name);
  json["rank"] = sample.record.rank;
  json["viscosity"] = sample.viscosity;
  json["distance"] = sample.distance_m < 0 ? Json() : Json(sample.distance_m);
  json["at_least"] = at_least(field, sample);
  return json;
}

}  // namespace vicinity::viewer
