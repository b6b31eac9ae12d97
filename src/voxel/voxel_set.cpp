// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/voxel_set.h"

#include <algorithm>

namespace vicinity {

void VoxelSet::insert_run(std::int32_t i_begin, std::int32_t i_end, std::int32_t j,
                          std::int32_t k) {
  const VoxelBox& b = box();
  if (j < b.lo.j || j >= b.hi.j || k < b.lo.k || k >= b.hi.k) return;
  i_begin = std::max(i_begin, b.lo.i);
  i_end = std::min(i_end, b.hi.i);
  const std::size_t row = BitBlock::row(j, k);
  while (i_begin < i_end) {
    const std::int32_t block_i = i_begin >> 6;
    const std::int32_t stop = std::min(i_end, (block_i + 1) * 64);
    const int length = stop - i_begin;
    const std::uint64_t ones = length == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << length) - 1;
    blocks_.make({block_i, j >> 3, k >> 3}).words[row] |= ones << (i_begin & 63);
    i_begin = stop;
  }
}

std::size_t VoxelSet::count() const noexcept {
  std::size_t n = 0;
  blocks_.for_each([&](const BlockIndex&, const BitBlock& block) {
    for (const std::uint64_t word : block.words) n += static_cast<std::size_t>(std::popcount(word));
  });
  return n;
}

}  // namespace vicinity
