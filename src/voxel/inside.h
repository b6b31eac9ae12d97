// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The inside of a mesh, prepared once and asked for box by box.
#pragma once

#include <memory>
#include <optional>

#include "open_inner.h"
#include "slabbed_mesh.h"
#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/inner.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

class Inside {
 public:
  /// @param as_given  the whole of `mesh` on the grid; it must stay alive
  Inside(const TriangleMesh& mesh, const SlabbedMesh& as_given, const Workspace& workspace,
         InnerMethod method);
  ~Inside();

  /// Inner voxels of the boundary's box, which need not hold the whole object: the surface within
  /// must be all that there is.
  VoxelSet inner(const VoxelSet& boundary) const;

  /// Whether all voxels of a box without boundary are inner, or none; nothing where that takes a
  /// closer look.
  std::optional<bool> throughout(const VoxelBox& box) const;

 private:
  bool is_inner(const VoxelIndex& v) const;

  InnerMethod method_;
  const SlabbedMesh* mesh_;
  TriangleMesh turned_;  // where some triangles are wound the wrong way
  std::unique_ptr<const SlabbedMesh> turned_slabs_;
  bool is_open_ = false;
  std::unique_ptr<const OpenInner> by_solid_angle_;  // where not every edge has two sides
};

}  // namespace vicinity
