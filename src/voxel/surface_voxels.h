// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Boundary voxels of a mesh, or of a part of one, in grid coordinates.
#pragma once

#include "slabbed_mesh.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

/// As boundary_voxels(), within the box of `mesh`. Those of a part are the whole mesh's within it.
VoxelSet surface_voxels(const SlabbedMesh& mesh, BoundaryMethod method);

}  // namespace vicinity
