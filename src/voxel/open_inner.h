// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Inner voxels of a mesh that is open.
#pragma once

#include <vector>

#include "open_edges.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

/// Voxels of the boundary's box, not in it, where the winding number is at least one half in size.
VoxelSet open_inner(const GridMesh& mesh, const std::vector<OpenEdge>& edges,
                    const VoxelSet& boundary);

}  // namespace vicinity
