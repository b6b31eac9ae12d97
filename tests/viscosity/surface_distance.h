// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Distance from a point to a mesh, triangle by triangle.
#pragma once

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity::test {

/// Exact up to rounding; O(triangles).
double surface_distance(const TriangleMesh& mesh, const Vec3& p);

}  // namespace vicinity::test
