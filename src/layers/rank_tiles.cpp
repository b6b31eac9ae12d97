// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
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

}  // namespace

void rank_tiles(const VoxelSet& boundary, const VoxelSet& inner, const ShapingElement& element,
                int q, const std::function<void(const LayerBricks&)>& visit) {
  if (q < 0 || q > 32) {
    throw Error({.where = "q",
                 .what = "not a number of ranks",
                 .found = std::to_string(q),
                 .expected = "0 to 32"});
  }
  if (q == 0 || boundary.box().empty()) return;
  const std::vector<VoxelBox> tiles = tiles_of(boundary.box().grown(q * element.radius()));
  tbb::enumerable_thread_specific<LayerBricks> memory;
  tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
    LayerBricks& bricks = memory.local();
    bricks.start(tiles[t], element.radius(), q);
    bricks.put_boundary(boundary);
    bricks.put_inner(inner);
    bricks.rank(element);
    visit(bricks);
  });
}

}  // namespace vicinity
