// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The workplace as boxes: MuJoCo's contacts know convex shapes only, and a workplace is none.
#pragma once

#include <cstdint>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/viscosity/field.h"

namespace vicinity {

/// A ball swept along a straight line: what a link is made of for contacts.
struct Capsule {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< shape (3,) [m]
  double radius = 0;                            ///< > 0 [m]
};

/// Boundary and inner voxels, merged greedily into boxes: along x as far as they go, then along y,
/// then along z. Every surface lies in a boundary voxel, so that the boxes are solid and stand out
/// from the true surface by less than a voxel.
class VoxelBoxes {
 public:
  /// @param within  only voxels that reach into this box, in W [m]
  /// Errors: throws Error for an empty box, and one of more than 2^31 voxels.
  VoxelBoxes(const ViscosityField& field, const Box& within);

  const std::vector<Box>& boxes() const noexcept { return boxes_; }

  /// Indices of the boxes within `reach` of the capsules, nearest first, `most` of them at most.
  /// Nearness is that of the capsule's axis, asked at five points of it.
  void near(const std::vector<Capsule>& capsules, double reach, std::size_t most,
            std::vector<std::uint32_t>& found) const;

 private:
  std::size_t cell_of(const Vec3& p_W, int axis) const noexcept;
  void sort_into_cells();

  std::vector<Box> boxes_;
  Box hull_;
  std::size_t cells_[3] = {1, 1, 1};
  std::vector<std::vector<std::uint32_t>> in_cell_;
};

}  // namespace vicinity
