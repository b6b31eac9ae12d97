// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "sets.h"

#include <algorithm>
#include <random>

namespace vicinity {

Triples triples(const VoxelSet& set) {
  Triples result;
  set.for_each([&](const VoxelIndex& v) { result.insert({v.i, v.j, v.k}); });
  return result;
}

Workspace grid_of(const TriangleMesh& mesh, int n) {
  const Box bounds = mesh.bounds();
  const double h = bounds.sizes().maxCoeff() / n;
  return Workspace::covering({bounds.min() - Vec3::Constant(h), bounds.max() + Vec3::Constant(h)},
                             h);
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [p, q, r] : b.triangles)
    a.triangles.push_back({p + first, q + first, r + first});
  return a;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& vertex : mesh.vertices) vertex += by;
  return mesh;
}

TriangleMesh inverted(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

TriangleMesh shuffled(TriangleMesh mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  for (auto& triangle : mesh.triangles) {
    std::rotate(triangle.begin(), triangle.begin() + random() % 3, triangle.end());
  }
  return mesh;
}

}  // namespace vicinity
