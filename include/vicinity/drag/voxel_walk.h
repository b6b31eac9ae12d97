// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Every voxel on a straight path, in order.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <type_traits>

#include "vicinity/geometry/vec3.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// Calls visit(const VoxelIndex& voxel, double enter, double leave) noexcept for every voxel on the
/// straight path between two points, from the first point's voxel to the second's. Enter and leave
/// are the fractions of the path, 0..1, between which it lies in the voxel.
///
/// Consecutive voxels share a face: a path through an edge or a corner passes, for no length, the
/// voxels beside it, so that it cannot slip diagonally between two voxels of a layer.
///
///   +---+---+---+     The number of steps along each axis is known from the ends alone. Each step
///   |   |   | b |     goes along the axis whose next grid plane is nearest, among the axes with
///   +---+---+-/-+     steps left. The walk therefore ends, and ends in b's voxel, whatever the
///   |   | .-|'  |     rounding of the fractions, which are computed from the ends and never
///   +---+/--+---+     summed.
///   | a-'   |   |
///   +---+---+---+
///
/// @param from,to  in voxels from the workspace's origin, shape (3,) (Workspace::to_grid());
/// finite,
///                 and within 2^31 voxels of the origin
/// Real-time: one call for each voxel: 1 + |di| + |dj| + |dk|; no allocation.
template <class Visit>
void walk_voxels(const Vec3& from, const Vec3& to, Visit&& visit) noexcept {
  static_assert(std::is_nothrow_invocable_v<Visit, const VoxelIndex&, double, double>);
  std::array<std::int64_t, 3> voxel{}, steps_left{}, direction{};
  std::array<double, 3> next_crossing{};
  const auto crossing = [&](std::size_t axis) {
    const auto plane = static_cast<double>(voxel[axis] + (direction[axis] > 0 ? 1 : 0));
    const auto a = static_cast<Eigen::Index>(axis);
    return (plane - from[a]) / (to[a] - from[a]);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    voxel[axis] = static_cast<std::int64_t>(std::floor(from[a]));
    const std::int64_t steps = static_cast<std::int64_t>(std::floor(to[a])) - voxel[axis];
    steps_left[axis] = std::abs(steps);
    direction[axis] = steps < 0 ? -1 : 1;
    if (steps != 0) next_crossing[axis] = crossing(axis);
  }
  const auto index = [&] {
    return VoxelIndex{static_cast<std::int32_t>(voxel[0]), static_cast<std::int32_t>(voxel[1]),
                      static_cast<std::int32_t>(voxel[2])};
  };
  double enter = 0;
  for (std::int64_t steps = steps_left[0] + steps_left[1] + steps_left[2]; steps > 0; --steps) {
    std::size_t nearest = 3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (steps_left[axis] > 0 && (nearest == 3 || next_crossing[axis] < next_crossing[nearest])) {
        nearest = axis;
      }
    }
    const double leave = next_crossing[nearest];
    visit(index(), enter, leave);
    enter = leave;
    voxel[nearest] += direction[nearest];
    if (--steps_left[nearest] > 0) next_crossing[nearest] = crossing(nearest);
  }
  visit(index(), enter, 1.0);
}

}  // namespace vicinity
