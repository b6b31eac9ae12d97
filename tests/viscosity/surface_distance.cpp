// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "surface_distance.h"

#include <algorithm>
#include <limits>

namespace vicinity::test {
namespace {

double segment_distance(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - (a + t * along)).norm();
}

double triangle_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const auto left_of = [&](const Vec3& from, const Vec3& to) {
    return (to - from).cross(p - from).dot(normal) >= 0;
  };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) return std::abs(normal.dot(p - a));
  return std::min(
      {segment_distance(a, b, p), segment_distance(b, c, p), segment_distance(c, a, p)});
}

}  // namespace

double surface_distance(const TriangleMesh& mesh, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    least =
        std::min(least, triangle_distance(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], p));
  }
  return least;
}

}  // namespace vicinity::test
