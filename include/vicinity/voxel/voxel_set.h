// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A sparse set of voxels, one bit each, in 64-bit rows along x.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "vicinity/voxel/block_grid.h"

namespace vicinity {

/// 64 x 8 x 8 bits, 512 bytes. Row (j,k) of the block is words[(k & 7) * 8 + (j & 7)]; voxel i is
/// bit i & 63 of its row.
struct BitBlock {
  std::array<std::uint64_t, 64> words{};

  static constexpr std::size_t row(std::int32_t j, std::int32_t k) noexcept {
    return static_cast<std::size_t>((k & 7) * 8 + (j & 7));
  }
};

/// Sparse set of voxels within a box. Threads may write voxels of different slabs (eight layers of
/// equal k >> 3) at the same time.
class VoxelSet {
 public:
  explicit VoxelSet(const VoxelBox& box = {}) : blocks_(box) {}

  const VoxelBox& box() const noexcept { return blocks_.box(); }
  const BlockGrid<BitBlock>& blocks() const noexcept { return blocks_; }
  BlockGrid<BitBlock>& blocks() noexcept { return blocks_; }

  /// Whether the voxel is in the set; false outside the box.
  bool contains(const VoxelIndex& v) const noexcept {
    const BitBlock* block = blocks_.find(block_of(v));
    return block != nullptr && ((block->words[BitBlock::row(v.j, v.k)] >> (v.i & 63)) & 1) != 0;
  }

  /// The 64 voxels from i = 64 * block_i in row (j,k), lowest i in the lowest bit.
  std::uint64_t word(std::int32_t block_i, std::int32_t j, std::int32_t k) const noexcept {
    const BitBlock* block = blocks_.find({block_i, j >> 3, k >> 3});
    return block == nullptr ? 0 : block->words[BitBlock::row(j, k)];
  }

  /// Puts one voxel in; it must lie in the box.
  void insert(const VoxelIndex& v) {
    blocks_.make(block_of(v)).words[BitBlock::row(v.j, v.k)] |= std::uint64_t{1} << (v.i & 63);
  }

  /// Puts voxels i_begin <= i < i_end of row (j,k) in; the part outside the box is left out.
  void insert_run(std::int32_t i_begin, std::int32_t i_end, std::int32_t j, std::int32_t k);

  /// Number of voxels in the set.
  std::size_t count() const noexcept;

  /// Calls visit(VoxelIndex) for every voxel: block by block, within a block by k, j, i.
  template <class Visit>
  void for_each(Visit&& visit) const {
    blocks_.for_each([&](const BlockIndex& b, const BitBlock& block) {
      for (std::int32_t row = 0; row < 64; ++row) {
        for (std::uint64_t bits = block.words[static_cast<std::size_t>(row)]; bits != 0;
             bits &= bits - 1) {
          visit(VoxelIndex{b.i * 64 + std::countr_zero(bits), b.j * 8 + (row & 7),
                           b.k * 8 + (row >> 3)});
        }
      }
    });
  }

 private:
  BlockGrid<BitBlock> blocks_;
};

}  // namespace vicinity
