// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Voxel sets as plain sets of triples, and meshes as tests want them.
#pragma once

#include <set>
#include <tuple>

#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

using Triples = std::set<std::tuple<int, int, int>>;

Triples triples(const VoxelSet& set);

/// A grid of n voxels along the mesh's longest side, from one voxel below its lower corner.
Workspace grid_of(const TriangleMesh& mesh, int n);

/// All triangles of both.
TriangleMesh joined(TriangleMesh a, const TriangleMesh& b);

/// Moved by `by` [m], wound the other way round, or in another order with turned corners.
TriangleMesh moved(TriangleMesh mesh, const Vec3& by);
TriangleMesh inverted(TriangleMesh mesh);
TriangleMesh shuffled(TriangleMesh mesh, unsigned seed);

}  // namespace vicinity
