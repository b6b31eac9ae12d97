// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/moving_point.h"

#include "vicinity/drag/approach.h"

namespace vicinity {

double MovingPoint::advance(const ViscosityField& field, const MemoryWeights& weights,
                            Traversal traversal, const Vec3& p_W) noexcept {
  if (!p_W.allFinite()) return started_ ? memory_.effective(weights) : 0;
  const Vec3 from = to_reachable_grid(field.workspace(), p_W_);
  const Vec3 to = to_reachable_grid(field.workspace(), p_W);
  const VoxelIndex arrived = voxel_of(to);
  const double mu = field.at(p_W).viscosity;
  p_W_ = p_W;
  if (!started_) {
    started_ = true;
    memory_.start(mu);
    towards_W_.setZero();
    voxel_ = arrived;
    return memory_.effective(weights);
  }
  if (traversal == Traversal::swept) {
    return record_path(field, weights, from, to, mu, voxel_, memory_);
  }
  if (arrived == voxel_) {
    memory_.update(mu);
  } else {
    memory_.enter_voxel(mu);
    voxel_ = arrived;
  }
  return memory_.effective(weights);
}

Vec3 MovingPoint::towards_surface(const ViscosityField& field) noexcept {
  if (field.at(p_W_).record.kind != VoxelKind::empty) {
    towards_W_ = vicinity::towards_surface(field, p_W_);
  }
  return towards_W_;
}

}  // namespace vicinity
