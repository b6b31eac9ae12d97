// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Meshes as fine as scans, of 70 thousand and of a million triangles.
#pragma once

#include <string>
#include <vector>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity::peers {

struct Scan {
  std::string name;
  TriangleMesh mesh;
};

/// A scanned statue where VICINITY_DATA has it, else a torus, refined and roughened.
const std::vector<Scan>& scans();

}  // namespace vicinity::peers
