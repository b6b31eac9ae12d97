// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Rank n is the dilation of rank n - 1 by the shaping element, less whatever is taken. Work is done
// brick by brick, only where there is a frontier, and a tile's bricks stay in the caches.
//
// Only the frontier needs to be dilated: those voxels of rank n - 1 with a 6-neighbour that is
// neither boundary nor ranked yet. Proof: let u have rank n, so that it lies in the element around
// some w of rank n - 1. Walk from w to u by single steps along the axes, each of which brings one
// component of the offset nearer to zero. The element holds, with a cell, every cell whose
// components are no larger in size, so that u lies in the element around every voxel of this walk.
// None of them is boundary or has a rank below n - 1, else u would have a rank below n. The voxel
// after the last one of rank n - 1 on the walk therefore is unranked or inner: the last one is
// frontier. Nothing is assumed of the object: inner voxels may touch empty ones.

#include "vicinity/layers/layer_bricks.h"

#include <algorithm>
#include <bit>

#include "brick_rows.h"
#include "brick_stamp.h"

namespace vicinity {
namespace {

bool is_full(const BrickBits& bits) noexcept {
  std::uint64_t all = ~std::uint64_t{0};
  for (const std::uint64_t word : bits.words) all &= word;
  return all == ~std::uint64_t{0};
}

void join(const BrickBits& bits, BrickBits& with) noexcept {
  for (std::size_t k = 0; k < 8; ++k) with.words[k] |= bits.words[k];
}

// Of a brick's 27: those that begin and end within bounds along an axis.
struct BricksAround {
  using Along = std::array<std::uint32_t, 3>;  // those a step back, here, a step on
  Along along_i{}, along_j{}, along_k{};

  BricksAround() noexcept {
    for (int di = -1; di <= 1; ++di) {
      for (int dj = -1; dj <= 1; ++dj) {
        for (int dk = -1; dk <= 1; ++dk) {
          const std::uint32_t brick = std::uint32_t{1} << BrickStamp::index_of(di, dj, dk);
          along_i[static_cast<std::size_t>(di + 1)] |= brick;
          along_j[static_cast<std::size_t>(dj + 1)] |= brick;
          along_k[static_cast<std::size_t>(dk + 1)] |= brick;
        }
      }
    }
  }

  static std::uint32_t within(std::int32_t at, std::int32_t lo, std::int32_t hi,
                              const Along& along) noexcept {
    std::uint32_t bricks = 0;
    for (std::int32_t step = -1; step <= 1; ++step) {
      if (at + step >= lo && at + step < hi) bricks |= along[static_cast<std::size_t>(step + 1)];
    }
    return bricks;
  }
};

}  // namespace

void LayerBricks::start(const VoxelBox& tile, int m, int q) {
  m_ = m;
  q_ = q;
  box_ = tile.grown(halo(m, q));
  const auto in_bricks = [](const VoxelIndex& v) {
    return BlockIndex{v.i >> 3, v.j >> 3, v.k >> 3};
  };
  tile_lo_ = in_bricks(tile.lo);
  tile_hi_ = in_bricks(tile.hi);
  const BlockIndex lo = in_bricks(box_.lo), hi = in_bricks(box_.hi);
  lo_ = {lo.i - 1, lo.j - 1, lo.k - 1};
  size_ = {hi.i - lo.i + 2, hi.j - lo.j + 2, hi.k - lo.k + 2};
  plane_count_ = static_cast<std::size_t>(std::bit_width(object_code::count(q) - 1));

  // Bricks of the last tile are taken out of the directory where it keeps its size: it is far
  // larger than what it lists.
  const std::size_t cell_count = static_cast<std::size_t>(size_.i) *
                                 static_cast<std::size_t>(size_.j) *
                                 static_cast<std::size_t>(size_.k);
  if (directory_.size() == cell_count) {
    for (const std::uint32_t cell : cells_) directory_[cell] = 0;
    for (const std::uint32_t cell : full_cells_) directory_[cell] = 0;
  } else {
    directory_.assign(cell_count, 0);
  }
  // Room for every brick that there can be: what is not used is not touched, and nothing is moved.
  cells_.reserve(cell_count);
  work_.reserve(cell_count);
  reached_.reserve(cell_count);
  planes_.reserve(cell_count * plane_count_);
  full_cells_.clear();
  cells_.assign(2, 0);
  work_.assign(2, {});
  reached_.assign(2, {});
  planes_.assign(2 * plane_count_, {});
  BrickBits all;
  all.words.fill(~std::uint64_t{0});
  work_[full_inner].taken = all;
  add(full_inner, all, object_code::inner);
}

std::uint32_t LayerBricks::make(std::uint32_t cell) {
  std::uint32_t& id = directory_[cell];
  if (id == 0) {
    id = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back(cell);
    work_.emplace_back();
    reached_.emplace_back();
    planes_.resize(planes_.size() + plane_count_);
  }
  return id;
}

void LayerBricks::add(std::uint32_t id, const BrickBits& bits, unsigned code) noexcept {
  for (std::size_t plane = 0; plane < plane_count_; ++plane) {
    if ((code >> plane & 1) == 0) continue;
    join(bits, planes_[id * plane_count_ + plane]);
  }
}

void LayerBricks::put(const VoxelSet& voxels, unsigned code) {
  const std::int32_t first = std::max(voxels.blocks().lo().k, box_.lo.k >> 3);
  const std::int32_t last =
      std::min(voxels.blocks().lo().k + voxels.blocks().size().k, box_.hi.k >> 3);
  for (std::int32_t k = first; k < last; ++k) {
    voxels.blocks().for_each_in_slab(k, [&](const BlockIndex& b, const BitBlock& block) {
      if (b.j < box_.lo.j >> 3 || b.j >= box_.hi.j >> 3) return;
      const std::int32_t i_begin = std::max(b.i * 8, box_.lo.i >> 3);
      const std::int32_t i_end = std::min(b.i * 8 + 8, box_.hi.i >> 3);
      if (i_begin >= i_end) return;
      const std::array<BrickBits, 8> bricks = bricks_of(block);
      for (std::int32_t i = i_begin; i < i_end; ++i) {
        const BrickBits& bits = bricks[static_cast<std::size_t>(i & 7)];
        if (!bits.any()) continue;
        const std::uint32_t cell = cell_of({i, b.j, b.k});
        if (code == object_code::inner && is_full(bits)) {
          directory_[cell] = full_inner;
          full_cells_.push_back(cell);
          continue;
        }
        const std::uint32_t id = make(cell);
        if (code == object_code::inner) {
          join(bits, work_[id].taken);
          add(id, bits, code);
        } else {
          work_[id].newest = bits;
          changed_.push_back(id);
        }
      }
    });
  }
}

void LayerBricks::put_boundary(const VoxelSet& voxels) {
  changed_.clear();
  put(voxels, object_code::boundary);
}

void LayerBricks::put_inner(const VoxelSet& voxels) { put(voxels, object_code::inner); }

// Gives the newest voxels their code.
void LayerBricks::settle(unsigned code) noexcept {
  for (const std::uint32_t id : changed_) {
    auto& [taken, newest] = work_[id];
    join(newest, taken);
    join(newest, reached_[id]);
    add(id, newest, code);
  }
}

// Those of the newest voxels that have a 6-neighbour outside what is reached.
void LayerBricks::find_frontier() {
  frontier_.clear();
  const auto dim_i = static_cast<std::uint32_t>(size_.i);
  const auto dim_ij = dim_i * static_cast<std::uint32_t>(size_.j);
  for (const std::uint32_t id : changed_) {
    const std::uint32_t cell = cells_[id];
    const auto reached_at = [&](std::uint32_t at) -> const auto& {
      return reached_[directory_[at]].words;
    };
    const auto& here = reached_[id].words;
    const auto& before_x = reached_at(cell - 1);
    const auto& after_x = reached_at(cell + 1);
    const auto& before_y = reached_at(cell - dim_i);
    const auto& after_y = reached_at(cell + dim_i);
    const std::uint64_t below = reached_at(cell - dim_ij)[7];
    const std::uint64_t above = reached_at(cell + dim_ij)[0];
    constexpr std::uint64_t first_column = 0x0101010101010101;
    constexpr std::uint64_t last_column = first_column << 7;
    Frontier found{cell, {}};
    for (std::size_t k = 0; k < 8; ++k) {
      const std::uint64_t w = here[k];
      const std::uint64_t along_x =
          (((w << 1) & ~first_column) | ((before_x[k] >> 7) & first_column)) &
          (((w >> 1) & ~last_column) | ((after_x[k] << 7) & last_column));
      const std::uint64_t along_y =
          ((w << 8) | (before_y[k] >> 56)) & ((w >> 8) | (after_y[k] << 56));
      const std::uint64_t along_z = (k > 0 ? here[k - 1] : below) & (k < 7 ? here[k + 1] : above);
      found.bits.words[k] = work_[id].newest.words[k] & ~(along_x & along_y & along_z);
    }
    work_[id].newest = {};
    if (found.bits.any()) frontier_.push_back(found);
  }
  changed_.clear();
}

// Finds what the element reaches from the frontier and nobody has taken, within the tile and
// `margin` voxels around it.
void LayerBricks::spread(const ElementProfiles& element, std::int32_t margin) {
  const std::int32_t rim = (margin + 7) / 8;
  const BlockIndex lo = {tile_lo_.i - rim, tile_lo_.j - rim, tile_lo_.k - rim};
  const BlockIndex hi = {tile_hi_.i + rim, tile_hi_.j + rim, tile_hi_.k + rim};
  std::array<std::int32_t, BrickStamp::bricks_around> step{};  // from a cell to those around it
  BricksAround around;
  for (int di = -1; di <= 1; ++di) {
    for (int dj = -1; dj <= 1; ++dj) {
      for (int dk = -1; dk <= 1; ++dk) {
        step[BrickStamp::index_of(di, dj, dk)] = (dk * size_.j + dj) * size_.i + di;
      }
    }
  }
  BrickStamp stamp;
  for (const Frontier& source : frontier_) {
    dilate(source.bits, element, stamp);
    const BlockIndex at = place_of(source.cell);
    std::uint32_t bricks = stamp.reached_bricks & around.within(at.i, lo.i, hi.i, around.along_i) &
                           around.within(at.j, lo.j, hi.j, around.along_j) &
                           around.within(at.k, lo.k, hi.k, around.along_k);
    for (; bricks != 0; bricks &= bricks - 1) {
      const auto brick = static_cast<unsigned>(std::countr_zero(bricks));
      const auto cell =
          static_cast<std::uint32_t>(static_cast<std::int32_t>(source.cell) + step[brick]);
      const std::uint32_t known = directory_[cell];
      BrickBits free = stamp.at(brick);
      for (std::size_t k = 0; k < 8; ++k) free.words[k] &= ~work_[known].taken.words[k];
      if (!free.any()) continue;
      const std::uint32_t id = known != 0 ? known : make(cell);
      BrickBits& newest = work_[id].newest;
      if (!newest.any()) changed_.push_back(id);
      join(free, newest);
    }
  }
}

void LayerBricks::rank(const ShapingElement& element) {
  const ElementProfiles profiles(element);
  settle(object_code::boundary);
  for (int n = 1; n <= q_; ++n) {
    find_frontier();
    spread(profiles, (q_ - n) * m_);
    settle(object_code::of_rank(n));
  }
  changed_.clear();
}

}  // namespace vicinity
