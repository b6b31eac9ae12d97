// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A mesh in grid coordinates, or a part of one, its triangles listed by the slabs of eight layers
/// that they touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grid_mesh.h"

namespace vicinity {

/// Slab s holds the layers k with k >> 3 == s. One thread works on one slab, as BlockGrid asks, and
/// then needs only the slab's triangles.
class SlabbedMesh : public GridMesh {
 public:
  /// Errors: as GridMesh.
  SlabbedMesh(const TriangleMesh& mesh, const Workspace& workspace);

  /// A part: only these triangles are listed, and only in the slabs of `within`. What it takes to
  /// voxelise that box. Shares everything else with `whole`.
  /// @param triangles  in rising order
  SlabbedMesh(const GridMesh& whole, std::span<const std::uint32_t> triangles,
              const VoxelBox& within);

  /// First slab, and the one after the last.
  std::int32_t slab_begin() const noexcept { return box().lo.k >> 3; }
  std::int32_t slab_end() const noexcept {
    return box().empty() ? slab_begin() : ((box().hi.k - 1) >> 3) + 1;
  }

  /// Triangles listed in any slab, each once, in the order of the mesh.
  std::vector<std::uint32_t> triangles_listed() const;

  /// Triangles with a point in the slab, in the order of the mesh; empty outside the box.
  std::span<const std::uint32_t> triangles_in(std::int32_t slab) const noexcept {
    if (slab < slab_begin() || slab >= slab_end()) return {};
    const auto s = static_cast<std::size_t>(slab - slab_begin());
    return std::span(listed_).subspan(starts_[s], starts_[s + 1] - starts_[s]);
  }

 private:
  std::vector<std::size_t> starts_;  // of each slab in listed_, and the end
  std::vector<std::uint32_t> listed_;
};

}  // namespace vicinity
