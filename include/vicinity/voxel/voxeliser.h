// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Boundary and inner voxels of a mesh, one box at a time: a large object is never held whole.
#pragma once

#include <memory>
#include <optional>

#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/inner.h"
#include "vicinity/voxel/voxel_set.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// A mesh prepared for being voxelised. The voxels of a box are those of the whole object in it;
/// threads may ask for different boxes at the same time. The mesh must stay alive.
///
/// Where a mesh stays open, what is inner is settled block by block up to the accuracy that
/// inner_voxels() states, and may depend on the box where that is in doubt.
class Voxeliser {
 public:
  /// @param mesh       placed in W [m]
  /// @param workspace  the grid; only origin and voxel size matter
  /// Errors: throws Error where the mesh is not finite or spans more voxels than can be indexed.
  Voxeliser(const TriangleMesh& mesh, const Workspace& workspace, BoundaryMethod boundary,
            InnerMethod inner);
  ~Voxeliser();
  Voxeliser(Voxeliser&&) noexcept;
  Voxeliser& operator=(Voxeliser&&) noexcept;

  /// Smallest box that holds every boundary voxel, and so every inner one.
  const VoxelBox& box() const noexcept;

  /// As boundary_voxels(), within a box.
  /// @return  voxels in what of `box` lies in box()
  VoxelSet boundary(const VoxelBox& box) const;

  /// As inner_voxels(), within the box of `boundary`, which must be what boundary() gave for it.
  VoxelSet inner(const VoxelSet& boundary) const;

  /// Whether all voxels of a box that holds no boundary voxel are inner, or none are; nothing where
  /// only inner() can tell.
  std::optional<bool> inner_throughout(const VoxelBox& box) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace vicinity
