// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Rank n is the dilation of rank n - 1 by the shaping element, less whatever is taken. Rows of
// voxels are 64-bit words, and work is done block by block, only where there is a frontier.
//
// Only the frontier needs to be dilated: those voxels of rank n - 1 with a 6-neighbour that is
// neither boundary nor ranked yet. Proof: let u have rank n, so that it lies in the element around
// some w of rank n - 1. Walk from w to u by single steps along the axes, each of which brings one
// component of the offset nearer to zero. The element holds, with a cell, every cell whose
// components are no larger in size, so that u lies in the element around every voxel of this walk.
// None of them is boundary or has a rank below n - 1, else u would have a rank below n. The voxel
// after the last one of rank n - 1 on the walk therefore is unranked or inner: the last one is
// frontier. Nothing is assumed of the object: inner voxels may touch empty ones.

#include "vicinity/layers/ranked_neighbours.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

constexpr int block_rows = 8;    // along y and z; an element's radius is at most this
constexpr int reach_values = 9;  // 0..8

using Word = std::uint64_t;

/// Frontier of one block.
struct FrontierBlock {
  BlockIndex index;
  BitBlock voxels;
};
/// Frontier of the whole object, slab by slab.
using Frontier = std::vector<std::vector<FrontierBlock>>;

/// The element as profiles: what one layer of source rows gives to the layer dk above or below.
/// Layers with equal profiles (all of a cube, dk and -dk of a sphere) share one.
struct ElementProfiles {
  explicit ElementProfiles(const ShapingElement& element) : radius(element.radius()) {
    for (int dk = -radius; dk <= radius; ++dk) {
      Profile profile;
      profile.fill(-1);
      for (const ShapingElement::Row& row : element.rows()) {
        if (row.k == dk) profile[static_cast<std::size_t>(row.j + block_rows)] = row.reach;
      }
      const auto known = std::find(profiles.begin(), profiles.end(), profile);
      of_layer.push_back(static_cast<std::size_t>(known - profiles.begin()));
      if (known == profiles.end()) profiles.push_back(profile);
    }
  }

  using Profile = std::array<std::int32_t, 2 * block_rows + 1>;  // [dj + 8] -> reach, -1: no row
  int radius;
  std::vector<Profile> profiles;
  std::vector<std::size_t> of_layer;  // [dk + radius] -> profile
};

/// A block and the blocks that touch it along y and z: what a dilation of its rows can reach.
class Surroundings {
 public:
  Word& row(int j, int k) noexcept {
    return rows_[static_cast<std::size_t>(k + block_rows)]
                [static_cast<std::size_t>(j + block_rows)];
  }
  void clear() noexcept { rows_ = {}; }

 private:
  std::array<std::array<Word, 3 * block_rows>, 3 * block_rows> rows_{};
};

/// Rows of one block, in the order of BitBlock, dilated along x by every reach: [reach][row].
using Rows = std::array<Word, 64>;
using DilatedRows = std::array<Rows, reach_values>;

/// The part of a dilation along x that stays in the word (side 0), or passes into the word of
/// lower (-1) or higher (+1) i.
void dilate_along_x(const BitBlock& source, int radius, int side, DilatedRows& dilated) {
  for (std::size_t row = 0; row < 64; ++row) dilated[0][row] = side == 0 ? source.words[row] : 0;
  for (int reach = 1; reach <= radius; ++reach) {
    const Rows& shorter = dilated[static_cast<std::size_t>(reach - 1)];
    Rows& longer = dilated[static_cast<std::size_t>(reach)];
    for (std::size_t row = 0; row < 64; ++row) {
      const Word word = source.words[row];
      longer[row] = shorter[row] | (side < 0   ? word << (64 - reach)
                                    : side > 0 ? word >> (64 - reach)
                                               : (word << reach) | (word >> reach));
    }
  }
}

/// Adds the dilation along y and z.
void dilate_along_yz(const DilatedRows& dilated, const ElementProfiles& element,
                     Surroundings& surroundings) {
  const int m = element.radius;
  for (int k = 0; k < block_rows; ++k) {
    const auto words_at = [&](std::int32_t reach) {
      return &dilated[static_cast<std::size_t>(reach)][BitBlock::row(0, k)];
    };
    const Word* const longest = words_at(m);  // holds all others
    if (std::all_of(longest, longest + block_rows, std::logical_not{})) continue;
    std::array<std::array<Word, 3 * block_rows>, reach_values> sums;
    for (std::size_t p = 0; p < element.profiles.size(); ++p) {
      sums[p].fill(0);
      for (int dj = -m; dj <= m; ++dj) {
        const std::int32_t reach = element.profiles[p][static_cast<std::size_t>(dj + block_rows)];
        if (reach < 0) continue;
        const Word* const words = words_at(reach);
        Word* const sum = &sums[p][static_cast<std::size_t>(dj + block_rows)];
        for (std::size_t j = 0; j < block_rows; ++j) sum[j] |= words[j];
      }
    }
    for (int dk = -m; dk <= m; ++dk) {
      const auto& sum = sums[element.of_layer[static_cast<std::size_t>(dk + m)]];
      Word* const target = &surroundings.row(-block_rows, k + dk);
      for (std::size_t j = 0; j < sum.size(); ++j) target[j] |= sum[j];
    }
  }
}

/// Puts what is still free of a dilation into `rank`.
void give_rank(Surroundings& surroundings, const BlockIndex& source, int side,
               const VoxelSet& reached, const VoxelSet& inner, VoxelSet& rank) {
  for (int dk = -1; dk <= 1; ++dk) {
    for (int dj = -1; dj <= 1; ++dj) {
      BitBlock free;
      Word any = 0;
      for (int k = 0; k < block_rows; ++k) {
        for (int j = 0; j < block_rows; ++j) {
          const Word word = surroundings.row(dj * block_rows + j, dk * block_rows + k);
          free.words[BitBlock::row(j, k)] = word;
          any |= word;
        }
      }
      if (any == 0) continue;
      const BlockIndex target{source.i + side, source.j + dj, source.k + dk};
      for (const VoxelSet* taken : {&reached, &inner}) {
        const BitBlock* block = taken->blocks().find(target);
        if (block == nullptr) continue;
        any = 0;
        for (std::size_t row = 0; row < 64; ++row) {
          any |= free.words[row] &= ~block->words[row];
        }
      }
      if (any == 0) continue;
      BitBlock& block = rank.blocks().make(target);
      for (std::size_t row = 0; row < 64; ++row) block.words[row] |= free.words[row];
    }
  }
}

/// Gives a rank to what the element reaches from one slab of the frontier.
void stamp_slab(const std::vector<FrontierBlock>& frontier, const ElementProfiles& element,
                const VoxelSet& reached, const VoxelSet& inner, VoxelSet& rank) {
  const Word low_bits = (Word{1} << element.radius) - 1;
  const Word high_bits = low_bits << (64 - element.radius);
  DilatedRows dilated;
  Surroundings surroundings;
  for (const FrontierBlock& source : frontier) {
    Word any = 0;
    for (const Word word : source.voxels.words) any |= word;
    for (int side = -1; side <= 1; ++side) {
      if ((side < 0 && (any & low_bits) == 0) || (side > 0 && (any & high_bits) == 0)) continue;
      surroundings.clear();
      dilate_along_x(source.voxels, element.radius, side, dilated);
      dilate_along_yz(dilated, element, surroundings);
      give_rank(surroundings, source.index, side, reached, inner, rank);
    }
  }
}

/// Those voxels of a block of the newest rank that have a 6-neighbour outside `reached`.
BitBlock frontier_of(const BlockIndex& b, const BitBlock& newest, const VoxelSet& reached) {
  static constexpr BitBlock nothing{};
  const auto block_at = [&](int di, int dj, int dk) -> const BitBlock& {
    const BitBlock* block = reached.blocks().find({b.i + di, b.j + dj, b.k + dk});
    return block == nullptr ? nothing : *block;
  };
  const BitBlock& here = block_at(0, 0, 0);
  const BitBlock& before_x = block_at(-1, 0, 0);
  const BitBlock& after_x = block_at(1, 0, 0);
  const BitBlock& before_y = block_at(0, -1, 0);
  const BitBlock& after_y = block_at(0, 1, 0);
  const BitBlock& before_z = block_at(0, 0, -1);
  const BitBlock& after_z = block_at(0, 0, 1);
  BitBlock frontier;
  for (int k = 0; k < block_rows; ++k) {
    for (int j = 0; j < block_rows; ++j) {
      const std::size_t row = BitBlock::row(j, k);
      const Word along_x = ((here.words[row] << 1) | (before_x.words[row] >> 63)) &
                           ((here.words[row] >> 1) | (after_x.words[row] << 63));
      const Word along_y = (j > 0 ? here : before_y).words[BitBlock::row(j - 1, k)] &
                           (j < 7 ? here : after_y).words[BitBlock::row(j + 1, k)];
      const Word along_z = (k > 0 ? here : before_z).words[BitBlock::row(j, k - 1)] &
                           (k < 7 ? here : after_z).words[BitBlock::row(j, k + 1)];
      frontier.words[row] = newest.words[row] & ~(along_x & along_y & along_z);
    }
  }
  return frontier;
}

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

  const ElementProfiles profiles(element);
  VoxelSet reached(box);  // boundary and every rank so far
  const std::int32_t first = reached.blocks().lo().k;
  const std::int32_t last = first + reached.blocks().size().k;
  Frontier frontier(static_cast<std::size_t>(last - first));

  const auto add_to_reached = [&](const VoxelSet& newest) {
    const std::int32_t begin = newest.blocks().lo().k;
    tbb::parallel_for(begin, begin + newest.blocks().size().k, [&](std::int32_t slab) {
      newest.blocks().for_each_in_slab(slab, [&](const BlockIndex& b, const BitBlock& block) {
        BitBlock& sum = reached.blocks().make(b);
        for (std::size_t row = 0; row < 64; ++row) sum.words[row] |= block.words[row];
      });
    });
  };
  const auto find_frontier = [&](const VoxelSet& newest) {
    for (auto& blocks : frontier) blocks.clear();
    const std::int32_t begin = newest.blocks().lo().k;
    tbb::parallel_for(begin, begin + newest.blocks().size().k, [&](std::int32_t slab) {
      auto& blocks = frontier[static_cast<std::size_t>(slab - first)];
      newest.blocks().for_each_in_slab(slab, [&](const BlockIndex& b, const BitBlock& block) {
        const BitBlock voxels = frontier_of(b, block, reached);
        if (std::any_of(voxels.words.begin(), voxels.words.end(), std::identity{})) {
          blocks.push_back({b, voxels});
        }
      });
    });
  };

  const VoxelSet* newest = &boundary;
  for (VoxelSet& rank : result.ranks) {
    add_to_reached(*newest);
    find_frontier(*newest);
    // A slab of the frontier writes into three slabs of the rank: every third can go at once.
    for (std::int32_t turn = 0; turn < 3; ++turn) {
      tbb::parallel_for(first + turn, last, 3, [&](std::int32_t slab) {
        stamp_slab(frontier[static_cast<std::size_t>(slab - first)], profiles, reached, inner,
                   rank);
      });
    }
    newest = &rank;
  }
  return result;
}

}  // namespace vicinity
