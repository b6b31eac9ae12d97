// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The nearest surface of a point, by search: what a field lookup takes the place of (§3.3).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity::report {

/// Corners of a triangle, counter-clockwise seen from outside. Any unit of length.
using Corners = std::array<Vec3, 3>;

/// All triangles of a mesh, divided by `unit`.
std::vector<Corners> corners_of(const TriangleMesh& mesh, double unit);

/// Distance between a point and a triangle.
double distance_to(const Corners& triangle, const Vec3& p);

/// What the paper's search finds.
struct Projection {
  bool found = false;   ///< else p lies in a shaded corner
  double distance = 0;  ///< to the nearest of all planes that p projects into a triangle of
};

/// The paper's sequential search: of every triangle that p is before, its normal, the foot of p on
/// its plane, and, where that lies within the triangle, the distance; the least of all.
Projection nearest_by_projection(const std::vector<Corners>& triangles, const Vec3& p);

/// A bounding volume hierarchy over triangles (Embree), for exact distances.
class TriangleTree {
 public:
  explicit TriangleTree(std::vector<Corners> triangles);
  ~TriangleTree();
  TriangleTree(const TriangleTree&) = delete;
  TriangleTree& operator=(const TriangleTree&) = delete;

  struct Nearest {
    double distance = 0;
    std::uint32_t looked_at = 0;  ///< triangles whose distance was computed
  };
  Nearest nearest(const Vec3& p) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace vicinity::report
