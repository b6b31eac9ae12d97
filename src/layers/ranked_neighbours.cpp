// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/layers/ranked_neighbours.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "brick_rows.h"
#include "vicinity/layers/layer_bricks.h"

namespace vicinity {
namespace {

/// The voxels of a brick with this code.
BrickBits voxels_with(unsigned code, std::span<const BrickBits> planes) {
  BrickBits bits;
  bits.words.fill(~std::uint64_t{0});
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const std::uint64_t flip = (code >> p & 1) != 0 ? 0 : ~std::uint64_t{0};
    for (std::size_t k = 0; k < 8; ++k) bits.words[k] &= planes[p].words[k] ^ flip;
  }
  return bits;
}

/// Writes the ranked voxels of a tile into the sets of their ranks. Threads that do so at the same
/// time take turns slab by slab.
class RankSets {
 public:
  RankSets(std::vector<VoxelSet>& ranks, const VoxelBox& box)
      : ranks_(ranks),
        lo_(box.lo.k >> 3),
        turns_(static_cast<std::size_t>(((box.hi.k + 7) >> 3) - lo_)) {}

  void put(const LayerBricks& bricks) {
    // Eight bricks along x make a block; they come one after the other.
    BlockIndex at{};
    std::vector<std::array<BrickBits, 8>> of_rank(ranks_.size());
    std::uint64_t found = 0;  // ranks with a voxel in the block
    const auto flush = [&] {
      if (found == 0) return;
      const std::lock_guard turn(turns_[static_cast<std::size_t>(at.k - lo_)]);
      for (; found != 0; found &= found - 1) {
        const auto rank = static_cast<std::size_t>(std::countr_zero(found));
        add_bricks(of_rank[rank], ranks_[rank].blocks().make(at));
        of_rank[rank] = {};
      }
    };
    bricks.for_each_brick([&](const BlockIndex& b, std::span<const BrickBits> planes) {
      const BlockIndex block{b.i >> 3, b.j, b.k};
      if (!(block == at)) {
        flush();
        at = block;
      }
      for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
        const BrickBits bits =
            voxels_with(object_code::of_rank(static_cast<int>(rank) + 1), planes);
        if (!bits.any()) continue;
        of_rank[rank][static_cast<std::size_t>(b.i & 7)] = bits;
        found |= std::uint64_t{1} << rank;
      }
    });
    flush();
  }

 private:
  std::vector<VoxelSet>& ranks_;
  std::int32_t lo_;
  std::vector<std::mutex> turns_;
};

}  // namespace

RankedNeighbours ranked_neighbours(const VoxelSet& boundary, const VoxelSet& inner,
                                   const ShapingElement& element, int q) {
  RankedNeighbours result;
  const VoxelBox box =
      boundary.box().empty() ? VoxelBox{} : boundary.box().grown(std::max(q, 0) * element.radius());
  result.ranks.assign(static_cast<std::size_t>(std::clamp(q, 0, 32)), VoxelSet(box));
  RankSets sets(result.ranks, box);
  rank_tiles(boundary, inner, element, q, [&](const LayerBricks& bricks) { sets.put(bricks); });
  return result;
}

}  // namespace vicinity
