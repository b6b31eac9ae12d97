// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

Box TriangleMesh::bounds() const {
  Box box;
  for (const auto& triangle : triangles) {
    for (const std::uint32_t corner : triangle) box.extend(vertices[corner]);
  }
  return box;
}

}  // namespace vicinity
