// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Puts runs of voxels into one slab of a set, looking each block up once while runs stay in it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

class SlabWriter {
 public:
  SlabWriter(VoxelSet& voxels, std::int32_t slab) : voxels_(voxels), at_{0, 0, slab} {}

  /// Puts i_first <= i <= i_last of row (j,k) in; all of them lie in the set's box and in the slab.
  void put(std::int32_t i_first, std::int32_t i_last, std::int32_t j, std::int32_t k) {
    const std::size_t row = BitBlock::row(j, k);
    for (std::int32_t i = i_first; i <= i_last; i = (i | 63) + 1) {
      const std::uint64_t from = ~std::uint64_t{0} << (i & 63);
      const std::uint64_t to = ~std::uint64_t{0} >> (63 - (std::min(i_last, i | 63) & 63));
      block(i >> 6, j >> 3).words[row] |= from & to;
    }
  }

 private:
  // The last block made stays where it is until another one is made.
  BitBlock& block(std::int32_t i, std::int32_t j) {
    if (block_ == nullptr || at_.i != i || at_.j != j) {
      at_.i = i;
      at_.j = j;
      block_ = &voxels_.blocks().make(at_);
    }
    return *block_;
  }

  VoxelSet& voxels_;
  BlockIndex at_;
  BitBlock* block_ = nullptr;
};

}  // namespace vicinity
