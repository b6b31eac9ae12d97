// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Voxels of a small triangle by separating axes, all at once, wherever they leave no doubt.
#pragma once

#include <array>
#include <cstdint>

#include "vicinity/geometry/vec3.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// In a fine scan most triangles touch no more than two voxels along each axis. Their eight voxels
/// are looked at together, one in each lane, in single precision and without branches: what a
/// branch costs that goes either way is more than all of its arithmetic.
///
/// @param corners  of a triangle whose bounding box is at most 2 x 2 x 2 voxels, in grid
/// coordinates
/// @param lo       lowest voxel of that box
/// @param voxels   bit 4 k + 2 j + i for each voxel, counted from lo
/// @return         whether there is no doubt: not where a voxel's side is within 1e-4 of the
///                 triangle's, nor for slivers and triangles seen edge-on along an axis of the
///                 grid. Bits of voxels outside the bounding box mean nothing.
bool few_voxels(const std::array<Vec3, 3>& corners, const VoxelIndex& lo,
                unsigned& voxels) noexcept;

}  // namespace vicinity
