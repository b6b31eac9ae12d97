// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/moving_point.h"

#include <algorithm>
#include <cmath>

#include "vicinity/drag/approach.h"
#include "vicinity/drag/voxel_walk.h"

namespace vicinity {
namespace {

// Positions beyond are as far outside as can be: their indices still fit in 32 bits.
constexpr double farthest_vox = 1 << 30;

Vec3 to_reachable_grid(const Workspace& workspace, const Vec3& p_W) noexcept {
  return workspace.to_grid(p_W).cwiseMax(-farthest_vox).cwiseMin(farthest_vox);
}

VoxelIndex voxel_of(const Vec3& grid) noexcept {
  return {static_cast<std::int32_t>(std::floor(grid.x())),
          static_cast<std::int32_t>(std::floor(grid.y())),
          static_cast<std::int32_t>(std::floor(grid.z()))};
}

// Outside the workspace all is empty, and whoever has passed memory_capacity empty voxels remembers
// nothing else: the path beyond that margin need not be walked.
struct Reach {
  Vec3 lo, hi;

  explicit Reach(const VoxelIndex& dims)
      : lo(Vec3::Constant(-memory_capacity)),
        hi(Vec3(dims.i, dims.j, dims.k) + Vec3::Constant(memory_capacity)) {}

  bool contains(const Vec3& grid) const noexcept {
    return (grid.array() >= lo.array()).all() && (grid.array() <= hi.array()).all();
  }

  // Cuts the path from a to b down to its part within; false where there is none.
  bool clip(Vec3& a, Vec3& b) const noexcept {
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
};

}  // namespace

double MovingPoint::advance(const ViscosityField& field, const MemoryWeights& weights,
                            Traversal traversal, const Vec3& from_W, const Vec3& to_W) noexcept {
  if (!to_W.allFinite()) return started_ ? memory_.effective(weights) : 0;
  const Workspace& workspace = field.workspace();
  Vec3 from = to_reachable_grid(workspace, from_W), to = to_reachable_grid(workspace, to_W);
  const double mu = field.at(to_W).viscosity;
  p_W_ = to_W;
  if (!started_) {
    started_ = true;
    memory_.start(mu);
    towards_W_.setZero();
    voxel_ = voxel_of(to);
    return memory_.effective(weights);
  }

  double highest = 0;
  const auto arrive = [&](const VoxelIndex& voxel) noexcept {
    if (voxel == voxel_) {
      memory_.update(mu);
    } else {
      memory_.enter_voxel(mu);
      voxel_ = voxel;
    }
    highest = std::max(highest, memory_.effective(weights));
  };
  if (traversal == Traversal::sampled) {
    arrive(voxel_of(to));
    return highest;
  }
  if (!Reach(workspace.dims).clip(from, to)) return memory_.effective(weights);
  const VoxelIndex last = voxel_of(to);
  const bool continuous = field.keeps_distance();
  walk_voxels(from, to, [&](const VoxelIndex& voxel, double enter, double leave) noexcept {
    if (voxel == last) return arrive(voxel);
    if (voxel == voxel_) return;  // it was recorded when it was entered
    const Vec3 middle = from + 0.5 * (enter + leave) * (to - from);
    memory_.enter_voxel(continuous
                            ? field.at(workspace.origin + workspace.voxel_size * middle).viscosity
                            : field.viscosities()[field.code_at(voxel)]);
    voxel_ = voxel;
    highest = std::max(highest, memory_.effective(weights));
  });
  return highest;
}

Vec3 MovingPoint::towards_surface(const ViscosityField& field) noexcept {
  if (field.at(p_W_).record.kind != VoxelKind::empty) {
    towards_W_ = vicinity::towards_surface(field, p_W_);
  }
  return towards_W_;
}

}  // namespace vicinity
