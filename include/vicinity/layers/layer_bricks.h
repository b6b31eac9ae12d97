// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// One object's voxels in a tile of its array: bricks of 8 x 8 x 8 voxels, a few bits each.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "vicinity/layers/shaping_element.h"
#include "vicinity/voxel/huge_pages.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

struct ElementProfiles;  // see src/layers/brick_stamp.h

/// 8 x 8 x 8 bits, one cache line: voxel (i,j,k) is bit (j & 7) * 8 + (i & 7) of words[k & 7].
struct alignas(64) BrickBits {
  std::array<std::uint64_t, 8> words{};

  bool any() const noexcept {
    std::uint64_t sum = 0;
    for (const std::uint64_t word : words) sum |= word;
    return sum != 0;
  }
};

/// What a voxel is to its own object, other objects absent.
namespace object_code {
inline constexpr unsigned empty = 0, boundary = 1, inner = 2;
/// Code of rank n = 1..q.
constexpr unsigned of_rank(int n) noexcept { return 2 + static_cast<unsigned>(n); }
/// One more than the highest code of an object with q ranks.
constexpr unsigned count(int q) noexcept { return 3 + static_cast<unsigned>(q); }
}  // namespace object_code

/// Working memory for one tile after another. Give it a tile's boundary and inner voxels, let it
/// rank them, then read its bricks.
///
/// The rank of a voxel depends on nothing farther away than q * m voxels. Tiles therefore are
/// ranked alone, each with a halo of that width, and their ranks are those of the whole object.
class LayerBricks {
 public:
  /// The halo of a tile, a whole number of bricks [voxels].
  static std::int32_t halo(int m, int q) noexcept { return (m * q + 7) / 8 * 8; }

  /// Forgets the last tile and starts one.
  /// @param tile  its voxels, from and to multiples of 8
  void start(const VoxelBox& tile, int m, int q);

  /// The tile with its halo: what must be known of boundary and inner voxels.
  const VoxelBox& box() const noexcept { return box_; }

  /// Puts voxels of the box in; what lies beyond it is left out. Boundary and inner voxels do not
  /// overlap.
  void put_boundary(const VoxelSet& voxels);
  void put_inner(const VoxelSet& voxels);

  /// Ranks 1..q of the tile's voxels, as ranked_neighbours(). Its halo is worked in and is not
  /// right afterwards.
  /// @param element  of the radius m that the tile was started with
  void rank(const ShapingElement& element);

  /// Calls visit(BlockIndex in bricks, planes) for every brick of the tile, not of the halo, that
  /// holds any voxel, in order of k, j, i. Plane b holds bit b of every voxel's object_code.
  template <class Visit>
  void for_each_brick(Visit&& visit) const {
    for (std::int32_t k = tile_lo_.k; k < tile_hi_.k; ++k) {
      for (std::int32_t j = tile_lo_.j; j < tile_hi_.j; ++j) {
        for (std::int32_t i = tile_lo_.i; i < tile_hi_.i; ++i) {
          const std::uint32_t id = directory_[cell_of({i, j, k})];
          if (id == 0) continue;
          visit(BlockIndex{i, j, k},
                std::span(planes_).subspan(std::size_t{id} * plane_count_, plane_count_));
        }
      }
    }
  }

 private:
  // Brick 0 is nothing; brick 1 stands for every brick that is inner throughout.
  static constexpr std::uint32_t full_inner = 1;

  struct Work {
    BrickBits taken;   // inner, boundary, and every rank that has been given
    BrickBits newest;  // of the one that is being given
  };
  struct Frontier {
    std::uint32_t cell;
    BrickBits bits;
  };

  std::uint32_t cell_of(const BlockIndex& b) const noexcept {
    return static_cast<std::uint32_t>(((b.k - lo_.k) * size_.j + (b.j - lo_.j)) * size_.i +
                                      (b.i - lo_.i));
  }
  BlockIndex place_of(std::uint32_t cell) const noexcept {
    const auto dim_i = static_cast<std::uint32_t>(size_.i),
               dim_j = static_cast<std::uint32_t>(size_.j);
    return {lo_.i + static_cast<std::int32_t>(cell % dim_i),
            lo_.j + static_cast<std::int32_t>(cell / dim_i % dim_j),
            lo_.k + static_cast<std::int32_t>(cell / dim_i / dim_j)};
  }
  std::uint32_t make(std::uint32_t cell);
  void put(const VoxelSet& voxels, unsigned code);
  void add(std::uint32_t id, const BrickBits& bits, unsigned code) noexcept;
  void find_frontier();
  void spread(const ElementProfiles& element, std::int32_t margin);
  void settle(unsigned code) noexcept;

  int m_ = 0, q_ = 0;
  VoxelBox box_;
  BlockIndex tile_lo_, tile_hi_;  // in bricks
  BlockIndex lo_, size_;          // of the directory, in bricks: the box and a rim of one brick
  std::size_t plane_count_ = 0;
  HugeVector<std::uint32_t> directory_;  // cell -> brick
  HugeVector<std::uint32_t> cells_;      // brick -> cell
  HugeVector<std::uint32_t> full_cells_;
  HugeVector<Work> work_;
  HugeVector<BrickBits> reached_;      // boundary and every rank that has been given
  HugeVector<BrickBits> planes_;       // plane_count_ for each brick
  HugeVector<std::uint32_t> changed_;  // bricks with anything newest
  HugeVector<Frontier> frontier_;
};

/// Ranks a whole object, tile by tile.
///
/// @param boundary, inner  as of ranked_neighbours()
/// @param visit            called with each ranked tile, by any thread; the bricks are good until
/// it
///                         returns
/// Errors: throws Error for q outside 0..32.
void rank_tiles(const VoxelSet& boundary, const VoxelSet& inner, const ShapingElement& element,
                int q, const std::function<void(const LayerBricks&)>& visit);

}  // namespace vicinity
