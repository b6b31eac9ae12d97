// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/whole_loops.h"
#include "vicinity/geometry/error.h"
#include "vicinity/layers/layer_bricks.h"

namespace vicinity {
namespace {

// A tile is large beside its halo, and its bricks are small beside the caches.
constexpr std::int32_t usual_side = 256;

/// Where tiles end along an axis: as many as fit, all of nearly the same length.
std::vector<std::int32_t> ends(std::int32_t lo, std::int32_t hi) {
  const std::int32_t length = hi - lo;
  const std::int32_t count = std::max((length + usual_side / 2) / usual_side, 1);
  std::vector<std::int32_t> ends{lo & ~7};
  for (std::int32_t n = 1; n <= count; ++n) {
    const auto end = static_cast<std::int32_t>(lo + std::int64_t{length} * n / count);
    ends.push_back((end + 7) & ~7);
  }
  return ends;
}

/// The tiles that cover a box.
std::vector<VoxelBox> tiles_of(const VoxelBox& box) {
  const std::vector<std::int32_t> i = ends(box.lo.i, box.hi.i), j = ends(box.lo.j, box.hi.j),
                                  k = ends(box.lo.k, box.hi.k);
  std::vector<VoxelBox> tiles;
  for (std::size_t c = 1; c < k.size(); ++c) {
    for (std::size_t b = 1; b < j.size(); ++b) {
      for (std::size_t a = 1; a < i.size(); ++a) {
        tiles.push_back({{i[a - 1], j[b - 1], k[c - 1]}, {i[a], j[b], k[c]}});
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
  whole::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
    LayerBricks& bricks = memory.local();
    bricks.start(tiles[t], element.radius(), q);
    bricks.put_boundary(boundary);
    bricks.put_inner(inner);
    bricks.rank(element);
    visit(bricks);
  });
}

}  // namespace vicinity
