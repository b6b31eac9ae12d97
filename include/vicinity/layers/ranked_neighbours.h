// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Ranked neighbours: layers 1..q of voxels around an object (§4.2).
#pragma once

#include <vector>

#include "vicinity/layers/shaping_element.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

/// The layers of one object in its own object voxel array.
struct RankedNeighbours {
  std::vector<VoxelSet> ranks;  ///< ranks[n-1] holds the voxels of rank n, n = 1..q
};

/// Gives rank n to each empty voxel within the shaping element centred on a voxel of rank n-1
/// (rank 0 is the boundary), lowest n first (§4.2). The same voxels as the paper's triple loop.
///
/// @param boundary  the object's boundary voxels
/// @param inner     its inner voxels; they take no rank
/// @param element   the shaping element
/// @param q         number of ranks, 0..32
/// @return          q sets, in boxes that hold the whole object and all its layers
/// Errors: throws Error for q outside 0..32.
RankedNeighbours ranked_neighbours(const VoxelSet& boundary, const VoxelSet& inner,
                                   const ShapingElement& element, int q);

}  // namespace vicinity
