// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/layers/ranked_neighbours.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "vicinity/geometry/error.h"
#include "vicinity/layers/layer_bricks.h"

namespace vicinity {
namespace {

// A tile is large beside its halo, and its bricks are small beside the caches.
constexpr std::int32_t tile_side = 256;

/// The tiles that cover a box.
std::vector<VoxelBox> tiles_of(const VoxelBox& box) {
  const auto down = [](std::int32_t x) { return x & ~7; };
  std::vector<VoxelBox> tiles;
  for (std::int32_t k = down(box.lo.k); k < box.hi.k; k += tile_side) {
    for (std::int32_t j = down(box.lo.j); j < box.hi.j; j += tile_side) {
      for (std::int32_t i = down(box.lo.i); i < box.hi.i; i += tile_side) {
        const auto end = [](std::int32_t begin, std::int32_t hi) {
          return std::min(begin + tile_side, (hi + 7) & ~7);
        };
        tiles.push_back({{i, j, k}, {end(i, box.hi.i), end(j, box.hi.j), end(k, box.hi.k)}});
      }
    }
  }
  return tiles;
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
    bricks.for_each_brick([&](const BlockIndex& at, std::span<const BrickBits> planes) {
      const std::lock_guard turn(turns_[static_cast<std::size_t>(at.k - lo_)]);
      for (std::size_t n = 1; n <= ranks_.size(); ++n) {
        const unsigned code = object_code::of_rank(static_cast<int>(n));
        BrickBits bits;
        for (std::size_t k = 0; k < 8; ++k) {
          std::uint64_t word = ~std::uint64_t{0};
          for (std::size_t p = 0; p < planes.size(); ++p) {
            word &= (code >> p & 1) != 0 ? planes[p].words[k] : ~planes[p].words[k];
          }
          bits.words[k] = word;
        }
        if (!bits.any()) continue;
        BitBlock& block = ranks_[n - 1].blocks().make({at.i >> 3, at.j, at.k});
        const int shift = (at.i & 7) * 8;
        for (std::size_t row = 0; row < 64; ++row) {
          block.words[row] |= (bits.words[row >> 3] >> (row & 7) * 8 & 0xff) << shift;
        }
      }
    });
  }

 private:
  std::vector<VoxelSet>& ranks_;
  std::int32_t lo_;
  std::vector<std::mutex> turns_;
};

}  // namespace

RankedNeighbours ranked_neighbours(const VoxelSet& boundary, const VoxelSet& inner,
                                   const ShapingElement& element, int q) {
  if (q < 0 || q > 32) {
    throw Error({.where = "q",
                 .what = "not a number of ranks",
                 .found = std::to_string(q),
                 .expected = "0 to 32"});
  }
  RankedNeighbours result;
  const VoxelBox box =
      boundary.box().empty() ? VoxelBox{} : boundary.box().grown(q * element.radius());
  result.ranks.assign(static_cast<std::size_t>(q), VoxelSet(box));
  if (q == 0 || box.empty()) return result;

  RankSets sets(result.ranks, box);
  const std::vector<VoxelBox> tiles = tiles_of(box);
  tbb::enumerable_thread_specific<LayerBricks> memory;
  tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
    LayerBricks& bricks = memory.local();
    bricks.start(tiles[t], element.radius(), q);
    bricks.put_boundary(boundary);
    bricks.put_inner(inner);
    bricks.rank(element);
    sets.put(bricks);
  });
  return result;
}

}  // namespace vicinity
