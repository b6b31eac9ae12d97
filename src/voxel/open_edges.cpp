// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "open_edges.h"

#include <tbb/blocked_range.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <tuple>
#include <utility>

#include "geometry/whole_loops.h"

namespace vicinity {
namespace {

// Triangles or vertices that a thread takes at a time: some hundred microseconds of work.
constexpr std::size_t triangles_a_task = 1 << 14;

// Edge between two vertices, from the lower to the higher; surplus counts the way back as negative.
struct Edge {
  std::uint32_t low, high;
  int surplus;
};

// Edges of `count` items summed up, without those that cancel, in order. For item n,
// edges_of(n, edge) calls edge(low, high, surplus) for each of its edges. Linear but for the edges
// of one vertex: sorting all edges at once takes several times longer than voxelising.
template <class EdgesOf>
std::vector<Edge> cancelled(std::size_t count, std::size_t vertices, EdgesOf&& edges_of) {
  using Range = tbb::blocked_range<std::size_t>;
  const auto visit = [&](auto&& edge) {
    whole::parallel_for(Range(0, count, triangles_a_task), [&](const Range& range) {
      for (std::size_t n = range.begin(); n < range.end(); ++n) edges_of(n, edge);
    });
  };
  // Grouped by their lower vertex; the order within a group does not matter.
  std::vector<std::size_t> ends(vertices + 1);
  visit([&](std::uint32_t low, std::uint32_t, int) {
    std::atomic_ref(ends[low + 1]).fetch_add(1, std::memory_order_relaxed);
  });
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<std::pair<std::uint32_t, int>> grouped(ends.back());
  visit([&](std::uint32_t low, std::uint32_t high, int surplus) {
    // Each start moves up to where its group ends.
    grouped[std::atomic_ref(ends[low]).fetch_add(1, std::memory_order_relaxed)] = {high, surplus};
  });
  const std::size_t pieces = vertices / triangles_a_task + 1;
  std::vector<std::vector<Edge>> left(pieces);
  whole::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
    for (std::size_t low = vertices * piece / pieces; low < vertices * (piece + 1) / pieces;
         ++low) {
      const auto begin =
          grouped.begin() + static_cast<std::ptrdiff_t>(low == 0 ? 0 : ends[low - 1]);
      const auto end = grouped.begin() + static_cast<std::ptrdiff_t>(ends[low]);
      std::sort(begin, end);
      for (auto edge = begin; edge != end;) {
        int surplus = 0;
        const std::uint32_t high = edge->first;
        for (; edge != end && edge->first == high; ++edge) surplus += edge->second;
        if (surplus != 0) left[piece].push_back({static_cast<std::uint32_t>(low), high, surplus});
      }
    }
  });
  std::vector<Edge> all;
  for (const std::vector<Edge>& some : left) all.insert(all.end(), some.begin(), some.end());
  return all;
}

// Calls edge(low, high, surplus), unless both ends are one.
template <class Visit>
void orderly(std::uint32_t from, std::uint32_t to, int surplus, Visit&& edge) {
  if (from < to) edge(from, to, surplus);
  if (to < from) edge(to, from, -surplus);
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
  std::vector<Edge> edges =
      cancelled(mesh.triangle_count(), mesh.vertices().size(), [&](std::size_t t, auto&& edge) {
        const auto& [a, b, c] = mesh.triangles()[t];
        orderly(a, b, 1, edge);
        orderly(b, c, 1, edge);
        orderly(c, a, 1, edge);
      });
  if (crack > 0 && !edges.empty()) {
    const std::vector<std::uint32_t> stands = joined_across_cracks(edges, mesh, crack);
    edges = cancelled(edges.size(), mesh.vertices().size(), [&](std::size_t e, auto&& edge) {
      orderly(stands[edges[e].low], stands[edges[e].high], edges[e].surplus, edge);
    });
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
