// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Inner voxels: those inside the object and not on its boundary (§4.1.3).
#pragma once

#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

enum class InnerMethod {
  winding,  ///< where the generalised winding number is at least one half in size; the default
  raster,   ///< even-odd per z slice (§4.1.3)
  none,     ///< keep only the skin
};

/// Inner voxels of a mesh: none of them is in `boundary`.
///
/// `winding` first turns round triangles that are wound against most of their neighbours. A closed
/// mesh is then decided exactly, region by region. Cracks narrower than a thousandth of a voxel
/// count as closed. Where a mesh stays open, each voxel is decided by its winding number, up to the
/// accuracy of sums over far triangles, about 0.002. Neither method depends on the order of
/// triangles or the number of threads.
///
/// @param mesh       placed in W [m]
/// @param boundary   its `exact` boundary voxels: through a skin with gaps, regions would leak
/// @param workspace  the grid; only origin and voxel size matter
/// @return           voxels in the box of `boundary`
VoxelSet inner_voxels(const TriangleMesh& mesh, const VoxelSet& boundary,
                      const Workspace& workspace, InnerMethod method = InnerMethod::winding);

/// Generalised winding number of a mesh about a point: the signed solid angle of all triangles over
/// 4 pi. One inside a closed mesh that is wound outward, minus one where wound inward, zero
/// outside. Plain sum over all triangles. A point on a triangle counts that triangle as zero.
double winding_number(const TriangleMesh& mesh, const Vec3& p_W);

}  // namespace vicinity
