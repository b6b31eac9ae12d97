// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/scene.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace vicinity {
namespace {

/// Names are kept in the field as JSON, which holds UTF-8 only.
bool is_utf8(const std::string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

}  // namespace

void check_object(const SceneObject& object, const std::string& where) {
  if (object.name.empty() || !is_utf8(object.name)) {
    throw Error({.where = where,
                 .what = "the object has no usable name",
                 .expected = "name: some UTF-8 text"});
  }
  if (object.m < 1 || object.m > 8) {
    throw Error({.where = where,
                 .what = "m is out of range",
                 .found = fmt::format("{}", object.m),
                 .expected = "1 to 8 voxels"});
  }
  if (object.q < 0 || object.q > 32) {
    throw Error({.where = where,
                 .what = "q is out of range",
                 .found = fmt::format("{}", object.q),
                 .expected = "0 to 32 ranks"});
  }
  if (!(object.scale > 0) || !std::isfinite(object.scale)) {
    throw Error({.where = where,
                 .what = "scale is not a size",
                 .found = fmt::format("{}", object.scale),
                 .expected = "a positive finite number"});
  }
  if (!object.X_WO.matrix().allFinite()) {
    throw Error({.where = where, .what = "the pose is not finite"});
  }
  check_coding(object.coding, object.q, where);
}

Error missing_unit(const TriangleMesh& mesh, const std::string& where) {
  return Error({.where = where,
                .what = "the mesh has no unit: none is stated, and none is read from mesh files",
                .found = size_in_units(mesh.bounds()),
                .expected = "units: mm, cm, m or in"});
}

}  // namespace vicinity
