// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/nearest_surface.h"

#include <algorithm>
#include <cmath>

namespace vicinity::report {
namespace {

// Whether the foot of a point, in the plane of the triangle, lies within it.
bool within(const Corners& t, const Vec3& normal, const Vec3& foot) {
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3 edge = t[(n + 1) % 3] - t[n];
    if (edge.cross(foot - t[n]).dot(normal) < 0) return false;
  }
  return true;
}

double distance_to_edge(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 edge = b - a;
  const double along = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (p - a - along * edge).norm();
}

}  // namespace

std::vector<Corners> corners_of(const TriangleMesh& mesh, double unit) {
  std::vector<Corners> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.push_back(
        {mesh.vertices[a] / unit, mesh.vertices[b] / unit, mesh.vertices[c] / unit});
  }
  return triangles;
}

double distance_to(const Corners& t, const Vec3& p) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  const double height = (p - t[0]).dot(normal);
  if (within(t, normal, p - height * normal)) return std::abs(height);
  return std::min({distance_to_edge(t[0], t[1], p), distance_to_edge(t[1], t[2], p),
                   distance_to_edge(t[2], t[0], p)});
}

Projection nearest_by_projection(const std::vector<Corners>& triangles, const Vec3& p) {
  Projection nearest;
  for (const Corners& t : triangles) {
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const double height = (p - t[0]).dot(normal);
    if (height < 0 || (nearest.found && height >= nearest.distance)) continue;
    if (within(t, normal, p - height * normal)) nearest = {true, height};
  }
  return nearest;
}

}  // namespace vicinity::report
