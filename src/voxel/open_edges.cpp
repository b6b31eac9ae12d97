// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "open_edges.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <tuple>
#include <utility>

namespace vicinity {
namespace {

// Edge between two vertices, from the lower to the higher; surplus counts the way back as negative.
struct Edge {
  std::uint32_t low, high;
  int surplus;
};

// Sums up equal edges and drops those that cancel. Linear but for the edges of one vertex: sorting
// all edges at once takes several times longer than voxelising.
std::vector<Edge> cancelled(const std::vector<Edge>& edges, std::size_t vertices) {
  std::vector<std::size_t> starts(vertices + 1);
  for (const Edge& edge : edges) ++starts[edge.low + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<std::pair<std::uint32_t, int>> grouped(edges.size());
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  for (const Edge& edge : edges) grouped[next[edge.low]++] = {edge.high, edge.surplus};
  std::vector<Edge> left;
  for (std::size_t low = 0; low < vertices; ++low) {
    const auto begin = grouped.begin() + static_cast<std::ptrdiff_t>(starts[low]);
    const auto end = grouped.begin() + static_cast<std::ptrdiff_t>(starts[low + 1]);
    std::sort(begin, end);
    for (auto edge = begin; edge != end;) {
      int surplus = 0;
      const std::uint32_t high = edge->first;
      for (; edge != end && edge->first == high; ++edge) surplus += edge->second;
      if (surplus != 0) left.push_back({static_cast<std::uint32_t>(low), high, surplus});
    }
  }
  return left;
}

void add(std::vector<Edge>& edges, std::uint32_t from, std::uint32_t to, int surplus) {
  if (from < to) edges.push_back({from, to, surplus});
  if (to < from) edges.push_back({to, from, -surplus});
}

// For each vertex of the edges, one that stands for all vertices within a crack of it. Two points
// closer than half a cell share a cell in at least one of eight grids shifted by half a cell.
std::vector<std::uint32_t> joined_across_cracks(const std::vector<Edge>& edges,
                                                const GridMesh& mesh, double crack) {
  std::vector<std::uint32_t> stands(mesh.vertices().size());
  std::iota(stands.begin(), stands.end(), std::uint32_t{0});
  const auto root = [&](std::uint32_t v) {
    while (stands[v] != v) v = stands[v] = stands[stands[v]];
    return v;
  };
  std::vector<std::uint32_t> ends;
  for (const Edge& edge : edges) ends.insert(ends.end(), {edge.low, edge.high});
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  using Cell = std::array<std::int64_t, 3>;
  std::vector<std::pair<Cell, std::uint32_t>> cells(ends.size());
  for (int shift = 0; shift < 8; ++shift) {
    const Vec3 offset(shift & 1 ? 0.5 : 0, shift & 2 ? 0.5 : 0, shift & 4 ? 0.5 : 0);
    for (std::size_t n = 0; n < ends.size(); ++n) {
      const Vec3 cell = (mesh.vertices()[ends[n]] / (2 * crack) + offset).array().floor();
      cells[n] = {Cell{static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                       static_cast<std::int64_t>(cell.z())},
                  ends[n]};
    }
    std::sort(cells.begin(), cells.end());
    for (std::size_t n = 0; n + 1 < cells.size(); ++n) {
      if (cells[n].first != cells[n + 1].first) continue;
      const std::uint32_t a = root(cells[n].second), b = root(cells[n + 1].second);
      stands[std::max(a, b)] = std::min(a, b);
    }
  }
  for (const std::uint32_t v : ends) stands[v] = root(v);
  return stands;
}

}  // namespace

std::vector<OpenEdge> open_edges(const GridMesh& mesh, double crack) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangle_count());
  for (const auto& [a, b, c] : mesh.triangles()) {
    add(edges, a, b, 1);
    add(edges, b, c, 1);
    add(edges, c, a, 1);
  }
  edges = cancelled(edges, mesh.vertices().size());
  if (crack > 0 && !edges.empty()) {
    const std::vector<std::uint32_t> stands = joined_across_cracks(edges, mesh, crack);
    std::vector<Edge> wide;
    for (const Edge& edge : edges) add(wide, stands[edge.low], stands[edge.high], edge.surplus);
    edges = cancelled(wide, mesh.vertices().size());
  }
  std::vector<OpenEdge> open;
  for (const Edge& edge : edges) {
    Vec3 from = mesh.vertices()[edge.low], to = mesh.vertices()[edge.high];
    if (edge.surplus < 0) std::swap(from, to);
    open.push_back({from, to, std::abs(edge.surplus)});
  }
  std::sort(open.begin(), open.end(), [](const OpenEdge& a, const OpenEdge& b) {
    const auto key = [](const OpenEdge& e) {
      return std::tuple(e.from.x(), e.from.y(), e.from.z(), e.to.x(), e.to.y(), e.to.z(),
                        e.surplus);
    };
    return key(a) < key(b);
  });
  return open;
}

}  // namespace vicinity
