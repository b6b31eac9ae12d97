// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Inner voxels of a mesh that is open.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "open_edges.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

class OpenWinding;

/// What it takes to decide voxels of an open mesh, prepared once. The mesh must stay alive.
class OpenInner {
 public:
  OpenInner(const GridMesh& mesh, const std::vector<OpenEdge>& edges);
  ~OpenInner();

  /// Voxels of the boundary's box, not in it, where the winding number is at least one half in
  /// size.
  VoxelSet inner(const VoxelSet& boundary) const;

  /// Whether all voxels of a box without boundary are inner, or none; nothing where that is unsure.
  std::optional<bool> throughout(const VoxelBox& box) const;

  /// Whether the winding number at a voxel is nearer to any other whole number than to zero: for
  /// meshes that are closed but for cracks.
  bool is_inner(const VoxelIndex& v) const;

 private:
  std::unique_ptr<const OpenWinding> winding_;
};

}  // namespace vicinity
