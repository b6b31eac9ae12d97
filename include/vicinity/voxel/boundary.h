// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Boundary voxels: those that a triangle passes through (§4.1, §4.1.2).
#pragma once

#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

enum class BoundaryMethod {
  exact,  ///< every voxel a triangle passes through; the safe default
  probe,  ///< grid lines through voxel centres, normal to the bounding brick's largest face
          ///< (§4.1.2)
};

/// Boundary voxels of a mesh.
///
/// `exact`: every point of every triangle lies in a voxel of the result, thin plates included. A
/// voxel that a triangle merely grazes within 1e-9 h of a face may go either way. `probe` gives a
/// subset of `exact`. Neither depends on the order of triangles or the number of threads.
///
/// @param mesh       placed in W [m]; triangles without area mark the voxels of their edges
/// @param workspace  the grid; only origin and voxel size matter
/// @return           voxels in the object's own box, which may reach beyond the workspace
VoxelSet boundary_voxels(const TriangleMesh& mesh, const Workspace& workspace,
                         BoundaryMethod method = BoundaryMethod::exact);

}  // namespace vicinity
