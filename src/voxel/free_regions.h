// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Connected regions of the voxels that are not boundary, without a dense array.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

/// Voxels of a block that lie in a box, which the block must touch.
BitBlock block_of_box(const BlockIndex& b, const VoxelBox& box);

/// Splits the voxels of a block into its 6-connected parts, ordered by their first voxel.
std::vector<BitBlock> connected_parts(const BitBlock& voxels);

/// 6-connected regions of the voxels that are not in a boundary, within its box.
///
/// No surface passes between two voxels of a region, so the winding number of a closed mesh is the
/// same at all of them.
///
/// A node is a run of blocks along x without boundary, or one connected part of any other block.
/// Per node only what the neighbouring slab must see is kept; parts are found again when visited.
class FreeRegions {
 public:
  explicit FreeRegions(const VoxelSet& boundary);

  /// One voxel of each region, the same for any number of threads.
  const std::vector<VoxelIndex>& voxels() const noexcept { return voxels_; }

  std::int32_t slab_begin() const noexcept { return lo_.k; }
  std::int32_t slab_end() const noexcept {
    return lo_.k + static_cast<std::int32_t>(slabs_.size());
  }

  /// Voxels of the box in a block that are not boundary.
  BitBlock free_voxels(const BlockIndex& b) const;

  /// For each part of slab `slab` whose region has wanted[region]: run(i_begin, i_end, j) for the
  /// free blocks i_begin <= i < i_end of block row j, part(BlockIndex, const BitBlock&) for parts
  /// of other blocks.
  template <class Run, class Part>
  void visit_slab(std::int32_t slab, const std::vector<char>& wanted, Run&& run,
                  Part&& part) const {
    const Slab& s = slabs_[static_cast<std::size_t>(slab - lo_.k)];
    for (std::int32_t row = 0; row < size_.j; ++row) {
      for (std::size_t e = s.rows[static_cast<std::size_t>(row)];
           e < s.rows[static_cast<std::size_t>(row) + 1]; ++e) {
        const Entry& entry = s.entries[e];
        if (entry.first_face == no_face) {
          if (wanted[region_[s.offset + entry.first_node]])
            run(entry.i_begin, entry.i_end, lo_.j + row);
          continue;
        }
        std::vector<BitBlock> parts;
        for (std::uint32_t n = 0; n < entry.nodes; ++n) {
          if (!wanted[region_[s.offset + entry.first_node + n]]) continue;
          const BlockIndex b{entry.i_begin, lo_.j + row, slab};
          if (parts.empty()) parts = connected_parts(free_voxels(b));
          part(b, parts[n]);
        }
      }
    }
  }

 private:
  static constexpr std::uint32_t no_face = 0xffffffff;

  // Part of a block seen by the block below, and by the one above: layers 0 and 7.
  struct Faces {
    std::array<std::uint64_t, 8> bottom, top;
  };

  // A run of free blocks (one node), or one block with some boundary (a node for each part).
  struct Entry {
    std::int32_t i_begin, i_end;
    std::uint32_t first_node;  // within the slab
    std::uint32_t nodes;
    std::uint32_t first_face;  // no_face for a run
  };

  struct Slab {
    std::vector<Entry> entries;
    std::vector<std::size_t> rows;       // where each block row starts in entries, and the end
    std::vector<VoxelIndex> voxels;      // the first of each node
    std::vector<std::uint32_t> parents;  // nodes linked within the slab
    std::vector<Faces> faces;
    std::size_t offset = 0;  // of the slab's nodes among all
  };

  bool is_free(const BlockIndex& b) const;
  Slab scan(std::int32_t k) const;

  template <class FaceOfA, class FaceOfB, class Link>
  static void link_rows(const Slab& a, std::size_t row_a, FaceOfA&& face_of_a, const Slab& b,
                        std::size_t row_b, FaceOfB&& face_of_b, Link&& link);

  const VoxelSet& boundary_;
  VoxelBox box_;
  BlockIndex lo_, size_;
  std::vector<Slab> slabs_;
  std::vector<std::uint32_t> region_;  // of each node
  std::vector<VoxelIndex> voxels_;
};

}  // namespace vicinity
