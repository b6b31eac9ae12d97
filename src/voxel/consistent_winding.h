// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Turning round the triangles that are wound against their neighbours.
#pragma once

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

/// The mesh with every patch wound one way, as most of its triangles are. A patch is connected
/// through edges of exactly two triangles; one with a single side, as a Moebius strip, stays as it
/// is. The same for any order of the triangles.
TriangleMesh consistently_wound(TriangleMesh mesh);

}  // namespace vicinity
