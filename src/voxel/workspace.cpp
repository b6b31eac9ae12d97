// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/workspace.h"

#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {

Workspace Workspace::covering(const Box& bounds, double voxel_size) {
  if (!(voxel_size > 0) || !std::isfinite(voxel_size)) {
    throw Error({.where = "voxel_size",
                 .what = "not a length",
                 .found = std::to_string(voxel_size),
                 .expected = "a positive number of metres",
                 .hint = "0.005"});
  }
  if (bounds.isEmpty() || !bounds.min().allFinite() || !bounds.max().allFinite()) {
    throw Error({.where = "bounds",
                 .what = "not a box",
                 .expected = "two finite corners, the lower one first",
                 .hint = "bounds: auto"});
  }
  constexpr double most_per_axis = 1 << 20;
  const Vec3 dims =
      ((bounds.max() - bounds.min()) / voxel_size - Vec3::Constant(1e-6)).array().ceil();
  if (dims.maxCoeff() > most_per_axis) {
    throw Error({.where = "voxel_size",
                 .what = "too small for these bounds",
                 .found = std::to_string(dims.maxCoeff()) + " voxels along one axis",
                 .expected = "at most 1048576",
                 .hint = "larger voxels, smaller bounds, or check the units of the meshes"});
  }
  const auto at_least_one = [](double n) { return std::max(1, static_cast<std::int32_t>(n)); };
  return {bounds.min(),
          voxel_size,
          {at_least_one(dims.x()), at_least_one(dims.y()), at_least_one(dims.z())}};
}

}  // namespace vicinity
