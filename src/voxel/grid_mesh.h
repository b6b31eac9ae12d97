// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A mesh in grid coordinates, within what indices can say.
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

/// Grid coordinates are those of Workspace::to_grid(). The mesh must outlive this.
class GridMesh {
 public:
  /// Errors: throws Error where the mesh is not finite or spans more voxels than can be indexed.
  GridMesh(const TriangleMesh& mesh, const Workspace& workspace);
  virtual ~GridMesh() = default;
  GridMesh(const GridMesh&) = default;

  /// Smallest box of voxels that holds every triangle, and of a part what of it is within; empty
  /// for no triangle.
  const VoxelBox& box() const noexcept { return box_; }

  /// Largest absolute grid coordinate of any triangle: what rounding errors are relative to.
  double reach() const noexcept { return reach_; }

  std::size_t triangle_count() const noexcept { return triangles_.size(); }
  std::span<const std::array<std::uint32_t, 3>> triangles() const noexcept { return triangles_; }

  /// Vertices in grid coordinates.
  std::span<const Vec3> vertices() const noexcept { return *vertices_; }

  /// Corners of a triangle in grid coordinates.
  std::array<Vec3, 3> corners(std::uint32_t triangle) const noexcept {
    const auto& [a, b, c] = triangles_[triangle];
    return {(*vertices_)[a], (*vertices_)[b], (*vertices_)[c]};
  }

 protected:
  /// Leaves only what is within: for a part of the mesh.
  void cut(const VoxelBox& within) noexcept { box_ = box_.within(within); }

 private:
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  std::shared_ptr<const std::vector<Vec3>> vertices_;  // of the whole, shared by its parts
  VoxelBox box_;
  double reach_ = 0;
};

}  // namespace vicinity
