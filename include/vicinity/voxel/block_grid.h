// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Sparse storage in blocks of 64 x 8 x 8 voxels: memory only where there is something.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "vicinity/voxel/block_store.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// A block is 64 x 8 x 8 voxels, aligned to multiples of (64, 8, 8) in the index space of the
/// workspace, so that one row of a block is one 64-bit word and eight blocks make one 64 x 64 x 8
/// slab of a field region.
struct BlockIndex {
  std::int32_t i = 0, j = 0, k = 0;
  friend bool operator==(const BlockIndex&, const BlockIndex&) = default;
};

inline BlockIndex block_of(const VoxelIndex& v) noexcept { return {v.i >> 6, v.j >> 3, v.k >> 3}; }

/// Sparse grid of blocks over a box of voxels.
///
/// Blocks with the same k form a slab: threads may create and write blocks of different slabs at
/// the same time. A block stays where it is as long as the grid lives, also when the grid is moved.
template <class Block>
class BlockGrid {
 public:
  explicit BlockGrid(const VoxelBox& box = {}) : box_(box) {
    if (box.empty()) return;
    lo_ = block_of(box.lo);
    const BlockIndex last = block_of({box.hi.i - 1, box.hi.j - 1, box.hi.k - 1});
    size_ = {last.i - lo_.i + 1, last.j - lo_.j + 1, last.k - lo_.k + 1};
    slabs_.resize(static_cast<std::size_t>(size_.k));
    blocks_ = std::make_unique<BlockStore<Block>>();
  }
  BlockGrid(const BlockGrid& other)
      : box_(other.box_), lo_(other.lo_), size_(other.size_), slabs_(other.slabs_) {
    if (other.blocks_) blocks_ = std::make_unique<BlockStore<Block>>(*other.blocks_);
  }
  BlockGrid(BlockGrid&&) noexcept = default;
  BlockGrid& operator=(BlockGrid other) noexcept {
    std::swap(box_, other.box_);
    std::swap(lo_, other.lo_);
    std::swap(size_, other.size_);
    slabs_.swap(other.slabs_);
    blocks_.swap(other.blocks_);
    return *this;
  }

  /// The voxels that may be stored.
  const VoxelBox& box() const noexcept { return box_; }
  /// First block along each axis, and how many blocks there are along each axis.
  const BlockIndex& lo() const noexcept { return lo_; }
  const BlockIndex& size() const noexcept { return size_; }

  /// The block, or nullptr where nothing is stored (also outside the box).
  const Block* find(const BlockIndex& b) const noexcept {
    const std::uint32_t id = id_of(b);
    return id == 0 ? nullptr : &(*blocks_)[id - 1];
  }
  Block* find(const BlockIndex& b) noexcept {
    return const_cast<Block*>(static_cast<const BlockGrid*>(this)->find(b));
  }

  /// The block, made (value-initialised) if it was not there. `b` must touch the box.
  Block& make(const BlockIndex& b) {
    Slab& slab = slabs_[static_cast<std::size_t>(b.k - lo_.k)];
    if (slab.empty()) {
      slab.resize(static_cast<std::size_t>(size_.i) * static_cast<std::size_t>(size_.j));
    }
    std::uint32_t& id = slab[cell(b)];
    if (id == 0) id = blocks_->add() + 1;
    return (*blocks_)[id - 1];
  }

  /// Calls visit(BlockIndex, const Block&) for every stored block of slab k, in order of j, then i.
  template <class Visit>
  void for_each_in_slab(std::int32_t k, Visit&& visit) const {
    const Slab& slab = slabs_[static_cast<std::size_t>(k - lo_.k)];
    for (std::size_t c = 0; c < slab.size(); ++c) {
      if (slab[c] == 0) continue;
      const auto i = static_cast<std::int32_t>(c % static_cast<std::size_t>(size_.i));
      const auto j = static_cast<std::int32_t>(c / static_cast<std::size_t>(size_.i));
      visit(BlockIndex{lo_.i + i, lo_.j + j, k}, (*blocks_)[slab[c] - 1]);
    }
  }

  /// Calls visit(BlockIndex, const Block&) for every stored block, in order of k, j, i.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::int32_t k = lo_.k; k < lo_.k + size_.k; ++k) for_each_in_slab(k, visit);
  }

  std::size_t block_count() const noexcept { return blocks_ ? blocks_->size() : 0; }

 private:
  /// Of each cell: 0 where nothing is stored, else 1 + number in blocks_. Empty where all are 0.
  using Slab = std::vector<std::uint32_t>;

  std::size_t cell(const BlockIndex& b) const noexcept {
    return static_cast<std::size_t>(b.j - lo_.j) * static_cast<std::size_t>(size_.i) +
           static_cast<std::size_t>(b.i - lo_.i);
  }
  std::uint32_t id_of(const BlockIndex& b) const noexcept {
    if (b.i < lo_.i || b.j < lo_.j || b.k < lo_.k || b.i >= lo_.i + size_.i ||
        b.j >= lo_.j + size_.j || b.k >= lo_.k + size_.k) {
      return 0;
    }
    const Slab& slab = slabs_[static_cast<std::size_t>(b.k - lo_.k)];
    return slab.empty() ? 0 : slab[cell(b)];
  }

  VoxelBox box_;
  BlockIndex lo_, size_;
  std::vector<Slab> slabs_;
  std::unique_ptr<BlockStore<Block>> blocks_;
};

}  // namespace vicinity
