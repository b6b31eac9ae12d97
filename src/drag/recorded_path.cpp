// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/recorded_path.h"

namespace vicinity {

bool clip_to_reach(const VoxelIndex& dims, Vec3& a, Vec3& b) noexcept {
  const Vec3 lo = Vec3::Constant(-memory_capacity);
  const Vec3 hi = Vec3(dims.i, dims.j, dims.k) + Vec3::Constant(memory_capacity);
  const auto contains = [&](const Vec3& grid) {
    return (grid.array() >= lo.array()).all() && (grid.array() <= hi.array()).all();
  };
  if (contains(a) && contains(b)) return true;
  const Vec3 way = b - a;
  double enter = 0, leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (a[axis] < lo[axis] || a[axis] > hi[axis]) return false;
      continue;
    }
    const double at_lo = (lo[axis] - a[axis]) / way[axis];
    const double at_hi = (hi[axis] - a[axis]) / way[axis];
    enter = std::max(enter, std::min(at_lo, at_hi));
    leave = std::min(leave, std::max(at_lo, at_hi));
  }
  if (enter > leave) return false;
  const Vec3 start = a;
  if (enter > 0) a = (start + enter * way).cwiseMax(lo).cwiseMin(hi);
  if (leave < 1) b = (start + leave * way).cwiseMax(lo).cwiseMin(hi);
  return true;
}

}  // namespace vicinity
