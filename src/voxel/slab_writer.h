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
  SlabWriter(VoxelSet& voxels, std::int32_t slab)
      : voxels_(voxels), first_(voxels.box().lo.i), last_(voxels.box().hi.i - 1), at_{0, 0, slab} {}

  /// Puts i_first <= i <= i_last of row (j,k) in, which lies in the set's box and in the slab; what
  /// of the run is beyond the box is left out.
  void put(std::int32_t i_first, std::int32_t i_last, std::int32_t j, std::int32_t k) {
    i_first = std::max(i_first, first_);
    i_last = std::min(i_last, last_);
    const std::size_t row = BitBlock::row(j, k);
    for (std::int32_t i = i_first; i <= i_last; i = (i | 63) + 1) {
      const std::uint64_t from = ~std::uint64_t{0} << (i & 63);
      const std::uint64_t to = ~std::uint64_t{0} >> (63 - (std::min(i_last, i | 63) & 63));
      block(i >> 6, j >> 3).words[row] |= from & to;
    }
  }

  /// Puts the voxels of a 2 x 2 x 2 cube in whose bits 4 k + 2 j + i are set, counted from `lo`;
  /// those that are set lie in the set's box and in the slab.
  void put_cube(const VoxelIndex& lo, unsigned bits) {
    if ((lo.i & 63) != 63 && (lo.j & 7) != 7) {
      BitBlock& in = block(lo.i >> 6, lo.j >> 3);
      for (std::int32_t row = 0; row < 4; ++row) {
        in.words[BitBlock::row(lo.j + (row & 1), lo.k + (row >> 1))] |=
            static_cast<std::uint64_t>((bits >> (2 * row)) & 3) << (lo.i & 63);
      }
      return;
    }
    for (std::int32_t row = 0; row < 4; ++row) {
      const unsigned pair = (bits >> (2 * row)) & 3;
      if (pair == 0) continue;
      put(lo.i + (pair == 2 ? 1 : 0), lo.i + (pair == 1 ? 0 : 1), lo.j + (row & 1),
          lo.k + (row >> 1));
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
  std::int32_t first_, last_;  // of the box along x
  BlockIndex at_;
  BitBlock* block_ = nullptr;
};

}  // namespace vicinity
