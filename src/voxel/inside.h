// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The inside of a mesh, prepared once and asked for box by box.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "open_inner.h"
#include "slabbed_mesh.h"
#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/inner.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

class Inside {
 public:
  /// @param as_given  the whole of `mesh` on the grid; it must stay alive
  /// @param slabs     the same with its triangles listed: worth its while to ask for many boxes,
  /// and
  ///                  what `raster` needs. Null to ask once.
  Inside(const TriangleMesh& mesh, const GridMesh& as_given, const SlabbedMesh* slabs,
         const Workspace& workspace, InnerMethod method);
  ~Inside();

  /// Inner voxels of the boundary's box, which need not hold the whole object: the surface within
  /// must be all that there is.
  VoxelSet inner(const VoxelSet& boundary) const;

  /// Whether all voxels of a box without boundary are inner, or none; nothing where that takes a
  /// closer look.
  std::optional<bool> throughout(const VoxelBox& box) const;

 private:
  std::vector<char> are_inner(const std::vector<VoxelIndex>& voxels) const;

  InnerMethod method_;
  const GridMesh* mesh_;
  const SlabbedMesh* slabs_;
  TriangleMesh turned_;  // where some triangles are wound the wrong way
  std::unique_ptr<const GridMesh> turned_on_grid_;
  bool is_open_ = false;
  std::unique_ptr<const OpenInner> by_solid_angle_;  // where not every edge has two sides
};

}  // namespace vicinity
