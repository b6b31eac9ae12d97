// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Distance from a point to a mesh by looking at triangles: the oracle of the distance layers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

/// Distance from p to the triangle abc, which may be degenerate, in the unit of its input.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Distance from p to the nearest triangle, by asking every one.
double distance_to_mesh(const TriangleMesh& mesh, const Vec3& p);

/// The same, by a tree of boxes around the triangles.
class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);
  /// The distance, or `limit` where nothing is nearer.
  double distance(const Vec3& p, double limit = std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    Box box;
    std::size_t begin, end;           // triangles
    std::size_t left = 0, right = 0;  // children; 0: a leaf
  };
  std::size_t add_node(std::size_t begin, std::size_t end);
  void search(std::size_t node, const Vec3& p, double& least) const;

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace vicinity
