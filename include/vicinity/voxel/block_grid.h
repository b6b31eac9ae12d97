// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Sparse storage in blocks of 64 x 8 x 8 voxels: memory only where there is something.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

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
/// Blocks with the same k form a slab, and each slab owns its storage: threads may create and write
/// blocks of different slabs at the same time. Creating a block invalidates references to other
/// blocks of its slab.
template <class Block>
class BlockGrid {
 public:
  explicit BlockGrid(const VoxelBox& box = {}) : box_(box) {
    if (box.empty()) return;
    lo_ = block_of(box.lo);
    const BlockIndex last = block_of({box.hi.i - 1, box.hi.j - 1, box.hi.k - 1});
    size_ = {last.i - lo_.i + 1, last.j - lo_.j + 1, last.k - lo_.k + 1};
    slabs_.resize(static_cast<std::size_t>(size_.k));
  }

  /// The voxels that may be stored.
  const VoxelBox& box() const noexcept { return box_; }
  /// First block along each axis, and how many blocks there are along each axis.
  const BlockIndex& lo() const noexcept { return lo_; }
  const BlockIndex& size() const noexcept { return size_; }

  /// The block, or nullptr where nothing is stored (also outside the box).
  const Block* find(const BlockIndex& b) const noexcept {
    const std::uint32_t id = id_of(b);
    return id == 0 ? nullptr : &slabs_[static_cast<std::size_t>(b.k - lo_.k)].blocks[id - 1];
  }
  Block* find(const BlockIndex& b) noexcept {
    return const_cast<Block*>(static_cast<const BlockGrid*>(this)->find(b));
  }

  /// The block, made (value-initialised) if it was not there. `b` must touch the box.
  Block& make(const BlockIndex& b) {
    Slab& slab = slabs_[static_cast<std::size_t>(b.k - lo_.k)];
    if (slab.ids.empty()) {
      slab.ids.resize(static_cast<std::size_t>(size_.i) * static_cast<std::size_t>(size_.j));
    }
    std::uint32_t& id = slab.ids[cell(b)];
    if (id == 0) {
      slab.blocks.emplace_back();
      id = static_cast<std::uint32_t>(slab.blocks.size());
    }
    return slab.blocks[id - 1];
  }

  /// Calls visit(BlockIndex, const Block&) for every stored block of slab k, in order of j, then i.
  template <class Visit>
  void for_each_in_slab(std::int32_t k, Visit&& visit) const {
    const Slab& slab = slabs_[static_cast<std::size_t>(k - lo_.k)];
    for (std::size_t c = 0; c < slab.ids.size(); ++c) {
      if (slab.ids[c] == 0) continue;
      const auto i = static_cast<std::int32_t>(c % static_cast<std::size_t>(size_.i));
      const auto j = static_cast<std::int32_t>(c / static_cast<std::size_t>(size_.i));
      visit(BlockIndex{lo_.i + i, lo_.j + j, k}, slab.blocks[slab.ids[c] - 1]);
    }
  }

  /// Calls visit(BlockIndex, const Block&) for every stored block, in order of k, j, i.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::int32_t k = lo_.k; k < lo_.k + size_.k; ++k) for_each_in_slab(k, visit);
  }

  std::size_t block_count() const noexcept {
    std::size_t n = 0;
    for (const Slab& slab : slabs_) n += slab.blocks.size();
    return n;
  }

 private:
  struct Slab {
    std::vector<std::uint32_t> ids;  // 0: nothing stored, else 1 + position in blocks
    std::vector<Block> blocks;
  };

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
    return slab.ids.empty() ? 0 : slab.ids[cell(b)];
  }

  VoxelBox box_;
  BlockIndex lo_, size_;
  std::vector<Slab> slabs_;
};

}  // namespace vicinity
