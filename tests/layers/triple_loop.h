// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The paper's own way to form ranked neighbours (§4.2, §5.1.1): the oracle of the layers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vicinity/layers/shaping_element.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity::triple_loop {

/// A dense object voxel array: -2 inner, -1 empty, 0 boundary, n rank n. The same numbers as in an
/// exported .npy.
struct ObjectVoxelArray {
  VoxelBox box;
  std::vector<std::int16_t> type;

  std::int16_t& at(int i, int j, int k) {
    const auto nx = static_cast<std::size_t>(box.hi.i - box.lo.i);
    const auto ny = static_cast<std::size_t>(box.hi.j - box.lo.j);
    return type[(static_cast<std::size_t>(k - box.lo.k) * ny +
                 static_cast<std::size_t>(j - box.lo.j)) *
                    nx +
                static_cast<std::size_t>(i - box.lo.i)];
  }
};

/// Ranks 1..q in an array that holds the boundary's box and all layers. A voxel that is in both
/// sets is boundary.
ObjectVoxelArray ranked_neighbours(const VoxelSet& boundary, const VoxelSet& inner,
                                   LayerShape shape, int m, int q);

}  // namespace vicinity::triple_loop
