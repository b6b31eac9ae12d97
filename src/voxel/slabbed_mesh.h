// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A mesh in grid coordinates, or a part of one, its triangles listed by the slabs of eight layers
/// that they touch.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// Index of the voxel row that holds grid coordinate x, |x| < 2^31. std::floor is a library call on
/// plain x86-64, and this is the innermost step of voxelising.
inline std::int32_t floor_index(double x) noexcept {
  const auto truncated = static_cast<std::int32_t>(x);
  return truncated - (x < truncated ? 1 : 0);
}

/// Grid coordinates are those of Workspace::to_grid(); slab s holds the layers k with k >> 3 == s.
/// One thread works on one slab, as BlockGrid asks, and then needs only the slab's triangles.
class SlabbedMesh {
 public:
  /// Errors: throws Error where the mesh is not finite or spans more voxels than can be indexed.
  SlabbedMesh(const TriangleMesh& mesh, const Workspace& workspace);

  /// The same mesh with only these triangles listed, and only in the slabs of `within`: what it
  /// takes to voxelise that box. Shares everything else.
  /// @param listed  in rising order
  SlabbedMesh part(std::span<const std::uint32_t> listed, const VoxelBox& within) const;

  /// Smallest box of voxels that holds every triangle, and of a part what of it is within; empty
  /// for no triangle.
  const VoxelBox& box() const noexcept { return box_; }

  /// Largest absolute grid coordinate of any triangle: what rounding errors are relative to.
  double reach() const noexcept { return reach_; }

  /// Triangles listed in any slab, each once, in the order of the mesh.
  std::vector<std::uint32_t> triangles_listed() const;

  std::size_t triangle_count() const noexcept { return triangles_.size(); }
  std::span<const std::array<std::uint32_t, 3>> triangles() const noexcept { return triangles_; }

  /// Vertices in grid coordinates.
  std::span<const Vec3> vertices() const noexcept { return *vertices_; }

  /// Corners of a triangle in grid coordinates.
  std::array<Vec3, 3> corners(std::uint32_t triangle) const noexcept {
    const auto& [a, b, c] = triangles_[triangle];
    return {(*vertices_)[a], (*vertices_)[b], (*vertices_)[c]};
  }

  /// First slab, and the one after the last.
  std::int32_t slab_begin() const noexcept { return box_.lo.k >> 3; }
  std::int32_t slab_end() const noexcept {
    return box_.empty() ? slab_begin() : ((box_.hi.k - 1) >> 3) + 1;
  }

  /// Triangles with a point in the slab, in the order of the mesh; empty outside the box.
  std::span<const std::uint32_t> triangles_in(std::int32_t slab) const noexcept {
    if (slab < slab_begin() || slab >= slab_end()) return {};
    const auto s = static_cast<std::size_t>(slab - slab_begin());
    return std::span(listed_).subspan(starts_[s], starts_[s + 1] - starts_[s]);
  }

 private:
  SlabbedMesh() = default;
  template <class Indices>
  void list(const Indices& triangles);

  std::span<const std::array<std::uint32_t, 3>> triangles_;
  std::shared_ptr<const std::vector<Vec3>> vertices_;
  VoxelBox box_;
  double reach_ = 0;
  std::vector<std::size_t> starts_;  // of each slab in listed_, and the end
  std::vector<std::uint32_t> listed_;
};

}  // namespace vicinity
