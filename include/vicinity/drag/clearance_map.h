// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// How far away from everything a point certainly is: the coarse, conservative level of a field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/viscosity/field.h"

namespace vicinity {

/// One byte for each cell of 8, 16, 32, ... voxels to a side: how many cells, along the axis where
/// that is most, lie between it and the nearest cell that is not empty.
class ClearanceMap {
 public:
  /// Cells are as small as a few megabytes allow.
  explicit ClearanceMap(const ViscosityField& field);

  /// A ball of this radius, in voxels, around the point holds empty space only: no boundary, inner
  /// or ranked voxel, nor one whose viscosity fades into empty space by interpolation. Zero where
  /// nothing is promised. Outside the workspace all is empty.
  /// @param grid  in voxels from the workspace's origin, shape (3,) (Workspace::to_grid()); finite
  /// Real-time: one load.
  double clearance_vox(const Vec3& grid) const noexcept;

 private:
  int cell_ = 8;     // voxels to a side
  VoxelIndex dims_;  // cells along each axis
  Vec3 size_;        // of the workspace, in voxels
  std::vector<std::uint8_t> cells_between_;
};

}  // namespace vicinity
