// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The voxel grid of the workspace: metres to indices and back (fig. 9).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vicinity/geometry/vec3.h"

namespace vicinity {

/// Index of a voxel: voxel (i,j,k) is the half-open cube from origin + h*(i,j,k). An object voxel
/// array may reach beyond the workspace, so that indices below zero are legal.
struct VoxelIndex {
  std::int32_t i = 0, j = 0, k = 0;
  friend bool operator==(const VoxelIndex&, const VoxelIndex&) = default;
};

/// Half-open box of voxels: lo inside, hi outside. Empty where any hi <= lo.
struct VoxelBox {
  VoxelIndex lo, hi;

  bool empty() const noexcept { return hi.i <= lo.i || hi.j <= lo.j || hi.k <= lo.k; }
  bool contains(const VoxelIndex& v) const noexcept {
    return v.i >= lo.i && v.i < hi.i && v.j >= lo.j && v.j < hi.j && v.k >= lo.k && v.k < hi.k;
  }
  /// This box with `margin` voxels more on every side.
  VoxelBox grown(std::int32_t margin) const noexcept {
    return {{lo.i - margin, lo.j - margin, lo.k - margin},
            {hi.i + margin, hi.j + margin, hi.k + margin}};
  }
  /// What of this box lies in another; empty where nothing does.
  VoxelBox within(const VoxelBox& other) const noexcept {
    return {{std::max(lo.i, other.lo.i), std::max(lo.j, other.lo.j), std::max(lo.k, other.lo.k)},
            {std::min(hi.i, other.hi.i), std::min(hi.j, other.hi.j), std::min(hi.k, other.hi.k)}};
  }
  friend bool operator==(const VoxelBox&, const VoxelBox&) = default;
};

/// The grid: origin, voxel size and number of voxels along each axis.
struct Workspace {
  Vec3 origin = Vec3::Zero();  ///< corner of voxel (0,0,0), in W [m]
  double voxel_size = 0.005;   ///< h [m]
  VoxelIndex dims;             ///< voxels along x, y, z

  /// p_W in voxels from the origin, shape (3,): integer part is the index.
  Vec3 to_grid(const Vec3& p_W) const noexcept { return (p_W - origin) / voxel_size; }

  /// Index of the voxel that holds p_W; |p_W| must be within 2^31 voxels of the origin.
  VoxelIndex index_of(const Vec3& p_W) const noexcept {
    const Vec3 g = to_grid(p_W);
    return {static_cast<std::int32_t>(std::floor(g.x())),
            static_cast<std::int32_t>(std::floor(g.y())),
            static_cast<std::int32_t>(std::floor(g.z()))};
  }

  /// Centre of a voxel, in W [m].
  Vec3 centre_of(const VoxelIndex& v) const noexcept {
    return origin + voxel_size * Vec3(v.i + 0.5, v.j + 0.5, v.k + 0.5);
  }

  VoxelBox box() const noexcept { return {{0, 0, 0}, dims}; }

  /// The grid that covers `bounds` from its lower corner: dims = ceil((hi - lo)/h - 1e-6).
  /// Errors: throws Error for a voxel size that is not a positive finite number, for empty or
  /// non-finite bounds, and for more than 2^20 voxels along an axis.
  static Workspace covering(const Box& bounds, double voxel_size);
};

}  // namespace vicinity
