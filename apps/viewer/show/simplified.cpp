// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "show/simplified.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vicinity::viewer {
namespace {

constexpr double finest_grid = 1024;  // cells along the longest edge; 3 x 21 bits make a key
constexpr double coarser = 1.5;

TriangleMesh clustered(const TriangleMesh& mesh, const Box& bounds, double cells) {
  const double size = bounds.sizes().maxCoeff() / cells;
  std::unordered_map<std::uint64_t, std::uint32_t> number;
  std::vector<std::uint32_t> of_vertex(mesh.vertices.size());
  std::vector<double> count;
  TriangleMesh result;
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    const Vec3 cell = ((mesh.vertices[n] - bounds.min()) / size).array().floor();
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      key = key << 21 | (static_cast<std::uint64_t>(std::max(0.0, cell[axis])) & 0x1FFFFF);
    }
    const auto [at, is_new] =
        number.try_emplace(key, static_cast<std::uint32_t>(result.vertices.size()));
    if (is_new) {
      result.vertices.push_back(Vec3::Zero());
      count.push_back(0);
    }
    of_vertex[n] = at->second;
    result.vertices[at->second] += mesh.vertices[n];
    count[at->second] += 1;
  }
  for (std::size_t n = 0; n < result.vertices.size(); ++n) result.vertices[n] /= count[n];
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t x = of_vertex[a], y = of_vertex[b], z = of_vertex[c];
    if (x != y && y != z && z != x) result.triangles.push_back({x, y, z});
  }
  return result;
}

}  // namespace

TriangleMesh simplified(const TriangleMesh& mesh, std::size_t most_triangles) {
  const Box bounds = mesh.bounds();
  if (mesh.triangles.size() <= most_triangles || !(bounds.sizes().maxCoeff() > 0)) return mesh;
  double cells = finest_grid;
  TriangleMesh result = clustered(mesh, bounds, cells);
  while (result.triangles.size() > most_triangles && cells > 1) {
    cells /= coarser;
    result = clustered(mesh, bounds, cells);
  }
  return result;
}

}  // namespace vicinity::viewer
