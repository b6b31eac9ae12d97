// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Voxel codes in a plane across an axis, for display.
#pragma once

#include <cstdint>
#include <vector>

#include "vicinity/viscosity/field.h"

namespace vicinity::viewer {

struct SliceCodes {
  int step = 1;             ///< voxels between two samples
  std::int32_t index = -1;  ///< of the voxels along the axis; -1: outside the workspace
  double where = 0;         ///< their middle along the axis [m]
  std::uint32_t width = 0, height = 0;
  std::vector<VoxelCode> codes;  ///< row by row, the first of the other two axes fastest
};

/// @param axis       0 x, 1 y, 2 z
/// @param where      along the axis [m]; outside the workspace, or not finite: an empty slice
/// @param most_side  samples along each side, at most; at least 1
SliceCodes slice_codes(const ViscosityField& field, int axis, double where, int most_side);

}  // namespace vicinity::viewer
