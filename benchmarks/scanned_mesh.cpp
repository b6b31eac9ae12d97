// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "scanned_mesh.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace vicinity::benchmarks {
namespace {

// Noise relative to the side of a small triangle: rough to the eye, and it rarely folds a surface.
constexpr double roughness = 0.2;

// Even noise in [-1, 1] of vertex `n` (splitmix64): the same on every machine, in any order.
double noise(std::uint64_t seed, std::uint64_t n) {
  std::uint64_t x = seed + (n + 1) * 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-52 - 1;
}

std::uint32_t grid_size(std::size_t triangles, std::size_t at_least) {
  std::uint32_t n = 1;
  while (triangles > 0 && triangles * n * n < at_least) ++n;
  return n;
}

TriangleMesh subdivided(const TriangleMesh& coarse, std::uint32_t n) {
  using Side = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Side> sides;
  for (const auto& t : coarse.triangles) {
    for (std::size_t c = 0; c < 3; ++c) sides.push_back(std::minmax(t[c], t[(c + 1) % 3]));
  }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());

  // The coarse vertices first, then n - 1 on each side from its lower end, then those within.
  TriangleMesh fine{coarse.vertices, {}};
  for (const auto& [a, b] : sides) {
    for (std::uint32_t s = 1; s < n; ++s) {
      fine.vertices.push_back(coarse.vertices[a] +
                              s * (coarse.vertices[b] - coarse.vertices[a]) / n);
    }
  }
  const auto on_side = [&](std::uint32_t from, std::uint32_t to, std::uint32_t s) {
    if (s == 0) return from;
    if (s == n) return to;
    const Side side = std::minmax(from, to);
    const auto at = std::lower_bound(sides.begin(), sides.end(), side) - sides.begin();
    return static_cast<std::uint32_t>(coarse.vertices.size() +
                                      static_cast<std::size_t>(at) * (n - 1) +
                                      (from == side.first ? s : n - s) - 1);
  };
  std::vector<std::vector<std::uint32_t>> rows(n + 1);
  for (const auto& [a, b, c] : coarse.triangles) {
    // Row r runs from side ac to side bc, parallel to ab, and has n - r + 1 vertices.
    for (std::uint32_t r = 0; r <= n; ++r) {
      rows[r].resize(n - r + 1);
      for (std::uint32_t s = 0; s <= n - r; ++s) {
        std::uint32_t& vertex = rows[r][s];
        if (r == 0) {
          vertex = on_side(a, b, s);
        } else if (s == 0) {
          vertex = on_side(a, c, r);
        } else if (s == n - r) {
          vertex = on_side(b, c, r);
        } else {
          vertex = static_cast<std::uint32_t>(fine.vertices.size());
          fine.vertices.push_back(coarse.vertices[a] +
                                  s * (coarse.vertices[b] - coarse.vertices[a]) / n +
                                  r * (coarse.vertices[c] - coarse.vertices[a]) / n);
        }
      }
    }
    for (std::uint32_t r = 0; r < n; ++r) {
      for (std::uint32_t s = 0; s < n - r; ++s) {
        fine.triangles.push_back({rows[r][s], rows[r][s + 1], rows[r + 1][s]});
        if (s + 1 < n - r) {
          fine.triangles.push_back({rows[r][s + 1], rows[r + 1][s + 1], rows[r + 1][s]});
        }
      }
    }
  }
  return fine;
}

}  // namespace

TriangleMesh scanned_mesh(const TriangleMesh& coarse, std::size_t at_least_triangles,
                          std::uint64_t seed) {
  TriangleMesh mesh = subdivided(coarse, grid_size(coarse.triangles.size(), at_least_triangles));
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  std::vector<double> sides(mesh.vertices.size(), 0);  // the shortest at each vertex
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const Vec3 normal = (b - a).cross(c - a);
    const double side = std::min({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    for (const std::uint32_t corner : t) {
      normals[corner] += normal;
      sides[corner] = sides[corner] == 0 ? side : std::min(sides[corner], side);
    }
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 moved =
        mesh.vertices[v] + roughness * sides[v] * noise(seed, v) * normals[v].normalized();
    mesh.vertices[v] = moved.cast<float>().cast<double>();
  }
  return mesh;
}

}  // namespace vicinity::benchmarks
