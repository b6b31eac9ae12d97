// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

namespace vicinity {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Corners closer than this share of the bounding box diagonal are the same point to a CAD program
/// that wrote them in 32 bit: float keeps 7 digits, and exporters lose two more.
constexpr double crack_width = 1e-5;

/// Which things are connected; things are numbers from 0 to n - 1.
class Connected {
 public:
  explicit Connected(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// The smaller number becomes the root, so that the result does not depend on the order.
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Items that belong to vertices, stored vertex by vertex: a counting sort, which for short lists
/// is several times faster than sorting all items at once.
template <class Item>
struct ByVertex {
  std::vector<std::size_t> begin;  // of each vertex's items; one more than there are vertices
  std::vector<Item> items;

  /// @param each  calls its argument with (vertex, item) for every item; called twice
  ByVertex(std::size_t vertices, const auto& each) : begin(vertices + 2, 0) {
    each([&](std::uint32_t vertex, const Item&) { ++begin[vertex + 2]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    items.resize(begin.back());
    each([&](std::uint32_t vertex, const Item& item) { items[begin[vertex + 1]++] = item; });
    begin.pop_back();
  }

  std::span<Item> of(std::size_t vertex) {
    return {items.data() + begin[vertex], items.data() + begin[vertex + 1]};
  }
};

/// Calls visit(run) for every run of items that are equal under `key`, after sorting by it.
void for_each_run(auto items, const auto& key, const auto& visit) {
  std::sort(items.begin(), items.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  for (std::size_t i = 0, end = 0; i < items.size(); i = end) {
    while (end < items.size() && key(items[end]) == key(items[i])) ++end;
    visit(items.subspan(i, end - i));
  }
}

bool repeats_a_corner(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

bool has_area(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a) != Vec3::Zero();
}

struct Edge {
  std::uint32_t from, to;
};

struct Edges {
  std::vector<Edge> open;
  std::size_t non_manifold = 0, inconsistent = 0;
  bool closed = true;
};

/// Looks at every edge with the triangles around it. Triangles that repeat a corner are left out:
/// they fold onto one edge and close nothing.
Edges look_at_edges(const TriangleMesh& mesh) {
  struct HalfEdge {
    std::uint32_t high;
    bool upward;  // walked from the lower to the higher vertex number
  };
  ByVertex<HalfEdge> edges(mesh.vertices.size(), [&](const auto& put) {
    for (const Triangle& t : mesh.triangles) {
      if (repeats_a_corner(t)) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = t[i], to = t[(i + 1) % 3];
        put(std::min(from, to), HalfEdge{std::max(from, to), from < to});
      }
    }
  });
  Edges result;
  for (std::uint32_t low = 0; low < mesh.vertices.size(); ++low) {
    const auto high = [](const HalfEdge& edge) { return edge.high; };
    for_each_run(edges.of(low), high, [&](std::span<const HalfEdge> around) {
      const std::size_t n = around.size();
      const auto up = static_cast<std::size_t>(std::count_if(
          around.begin(), around.end(), [](const HalfEdge& edge) { return edge.upward; }));
      if (n == 1) {
        const std::uint32_t other = around[0].high;
        result.open.push_back(up == 1 ? Edge{low, other} : Edge{other, low});
      }
      if (n == 2 && up != 1) ++result.inconsistent;
      if (n > 2) ++result.non_manifold;
      if (n != 2 && 2 * up != n) result.closed = false;
    });
  }
  return result;
}

struct Duplicates {
  std::size_t copies = 0;     // beyond the first of each set of three corners
  std::size_t cancelled = 0;  // triangles of sets that face both ways equally often
  std::size_t looked_at = 0;  // all triangles but those that repeat a corner
};

Duplicates look_for_duplicates(const TriangleMesh& mesh) {
  struct Rest {
    std::uint32_t mid, high;
    bool forward;  // the corners, in order, are an even permutation of the sorted ones
  };
  ByVertex<Rest> rests(mesh.vertices.size(), [&](const auto& put) {
    for (Triangle t : mesh.triangles) {
      if (repeats_a_corner(t)) continue;
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      const bool forward = t[1] < t[2];
      put(t[0], Rest{std::min(t[1], t[2]), std::max(t[1], t[2]), forward});
    }
  });
  Duplicates result{.looked_at = rests.items.size()};
  for (std::size_t low = 0; low < mesh.vertices.size(); ++low) {
    const auto corners = [](const Rest& rest) { return std::pair(rest.mid, rest.high); };
    for_each_run(rests.of(low), corners, [&](std::span<const Rest> same) {
      const auto forward = static_cast<std::size_t>(
          std::count_if(same.begin(), same.end(), [](const Rest& rest) { return rest.forward; }));
      result.copies += same.size() - 1;
      if (2 * forward == same.size()) result.cancelled += same.size();
    });
  }
  return result;
}

std::string what_duplicates_mean(const Duplicates& found) {
  if (found.cancelled == 0) {
    return "the same triangle more than once: the skin and the inside are as with one";
  }
  if (found.cancelled == found.looked_at) {
    return "every triangle is there facing both ways, as in a two-sided sheet, and the two cancel: "
           "the skin is complete, but nothing will be inside";
  }
  return fmt::format(
      "{} triangles lie on one that faces the other way, as in a two-sided sheet, and the two "
      "cancel: their skin is there, but they enclose nothing",
      found.cancelled);
}

std::size_t count_shells(const TriangleMesh& mesh) {
  Connected vertices(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    vertices.join(t[0], t[1]);
    vertices.join(t[1], t[2]);
  }
  std::vector<bool> used(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) used[vertices.root(t[0])] = true;
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
}

/// The ends of some edges, numbered from zero.
struct EdgeEnds {
  std::vector<std::uint32_t> vertices;  // sorted

  explicit EdgeEnds(const std::vector<Edge>& edges) {
    for (const auto& [from, to] : edges) vertices.insert(vertices.end(), {from, to});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }

  std::uint32_t number_of(std::uint32_t vertex) const {
    return static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), vertex) -
                                      vertices.begin());
  }
};

/// The open edges that stay open when their ends are merged with others nearer than `tolerance`.
std::vector<Edge> edges_beyond_cracks(const TriangleMesh& mesh, const std::vector<Edge>& open,
                                      double tolerance) {
  if (open.empty() || !(tolerance > 0)) return open;
  const EdgeEnds ends(open);
  Connected points(ends.vertices.size());
  // Cells twice as wide as the tolerance: all that is near a point lies in the eight cells around
  // the cell corner nearest to it.
  const Vec3 origin = mesh.bounds().min();
  const auto key = [](const Eigen::Vector3i& cell) {
    // 17 bits an axis: the diagonal is 1e5 tolerances long.
    return static_cast<std::uint64_t>(cell.x()) << 40 | static_cast<std::uint64_t>(cell.y()) << 20 |
           static_cast<std::uint64_t>(cell.z());
  };
  const auto in_cells = [&](std::uint32_t i) {
    return Vec3((mesh.vertices[ends.vertices[i]] - origin) / (2 * tolerance));
  };
  std::unordered_map<std::uint64_t, std::uint32_t> latest;  // point put into each cell
  latest.reserve(ends.vertices.size());
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> earlier(ends.vertices.size(), none);  // in the same cell
  for (std::uint32_t i = 0; i < ends.vertices.size(); ++i) {
    const Vec3 at = in_cells(i);
    const Eigen::Vector3i corner = (at + Vec3::Constant(0.5)).array().floor().cast<int>();
    for (int side = 0; side < 8; ++side) {
      const Eigen::Vector3i cell = corner - Eigen::Vector3i(side & 1, side >> 1 & 1, side >> 2 & 1);
      if (cell.minCoeff() < 0) continue;
      const auto found = latest.find(key(cell));
      for (std::uint32_t j = found == latest.end() ? none : found->second; j != none;
           j = earlier[j]) {
        const Vec3 apart = mesh.vertices[ends.vertices[i]] - mesh.vertices[ends.vertices[j]];
        if (apart.norm() <= tolerance) points.join(i, j);
      }
    }
    const auto [place, fresh] = latest.try_emplace(key(at.array().floor().cast<int>()), i);
    if (!fresh) earlier[i] = std::exchange(place->second, i);
  }

  struct Merged {
    std::uint32_t low, high;
    Edge edge;
  };
  std::vector<Merged> merged;
  for (const Edge& edge : open) {
    const std::uint32_t from = points.root(ends.number_of(edge.from));
    const std::uint32_t to = points.root(ends.number_of(edge.to));
    if (from != to) merged.push_back({std::min(from, to), std::max(from, to), edge});
  }
  std::vector<Edge> left;
  const auto both_ends = [](const Merged& m) { return std::pair(m.low, m.high); };
  for_each_run(std::span(merged), both_ends, [&](std::span<const Merged> same) {
    if (same.size() % 2 == 0) return;
    for (const Merged& m : same) left.push_back(m.edge);
  });
  return left;
}

struct Holes {
  std::size_t count = 0;
  double largest = 0;  // diagonal of the box around the widest one
};

/// Open edges that hang together through shared vertices are the rim of one hole.
Holes look_at_holes(const TriangleMesh& mesh, const std::vector<Edge>& open) {
  const EdgeEnds ends(open);
  Connected points(ends.vertices.size());
  for (const Edge& edge : open) points.join(ends.number_of(edge.from), ends.number_of(edge.to));
  std::vector<Box> rims(ends.vertices.size());
  for (std::uint32_t i = 0; i < ends.vertices.size(); ++i) {
    rims[points.root(i)].extend(mesh.vertices[ends.vertices[i]]);
  }
  Holes holes;
  for (const Box& rim : rims) {
    if (rim.isEmpty()) continue;
    ++holes.count;
    holes.largest = std::max(holes.largest, rim.diagonal().norm());
  }
  return holes;
}

}  // namespace

MeshInspection inspect(const TriangleMesh& mesh) {
  MeshInspection found;
  found.triangles = mesh.triangles.size();
  found.bounds = mesh.bounds();
  found.shells = count_shells(mesh);
  found.degenerate_triangles = static_cast<std::size_t>(
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                    [&](const Triangle& t) { return !has_area(mesh, t); }));
  const Edges edges = look_at_edges(mesh);
  found.closed = edges.closed && found.degenerate_triangles < found.triangles;
  found.open_edges = edges.open.size();
  found.holes = look_at_holes(mesh, edges.open).count;
  found.non_manifold_edges = edges.non_manifold;
  found.inconsistent_edges = edges.inconsistent;
  const Duplicates duplicates = look_for_duplicates(mesh);
  found.duplicate_triangles = duplicates.copies;

  const double tolerance =
      found.bounds.isEmpty() ? 0 : crack_width * found.bounds.diagonal().norm();
  const std::vector<Edge> wide_open = edges_beyond_cracks(mesh, edges.open, tolerance);
  found.crack_edges = edges.open.size() - wide_open.size();

  const auto report = [&](const char* what, std::size_t count, std::string means) {
    if (count > 0) found.problems.push_back({what, count, std::move(means)});
  };
  report("crack edges", found.crack_edges,
         fmt::format("edges that ought to be shared, but whose ends differ by up to {:.2g} units, "
                     "as CAD programs export them: boundary voxels close such cracks, and the "
                     "object builds as if it were whole",
                     tolerance));
  const Holes holes = look_at_holes(mesh, wide_open);
  report(
      "open edges", wide_open.size(),
      fmt::format("the surface ends there: {} {}, the largest {:.3g} units across. The skin is "
                  "complete all the same. A hole narrower than a voxel seals itself, because "
                  "boundary voxels close it; through a wider one the inside counts as inside "
                  "only where the surface goes at least halfway round",
                  holes.count, holes.count == 1 ? "hole" : "holes or loose rims", holes.largest));
  report("inconsistent edges", found.inconsistent_edges,
         "the two triangles at such an edge disagree about which side is outside: the skin is not "
         "affected, but parts of the inside may count as empty");
  report("non-manifold edges", found.non_manifold_edges,
         "more than two triangles meet there, as where sheets or parts touch: the skin and the "
         "inside are built as they are, nothing is lost");
  report("duplicate triangles", duplicates.copies, what_duplicates_mean(duplicates));
  report("degenerate triangles", found.degenerate_triangles,
         "they have no area: they add nothing to the surface and are harmless");

  if (found.degenerate_triangles == found.triangles) {
    found.verdict = MeshInspection::Verdict::unusable;
    if (found.triangles == 0) {
      found.problems.push_back({"triangles", 0, "there is no surface to build layers around"});
    } else {
      found.problems.back().means = "no triangle has any area: there is no surface to build around";
    }
  } else if (!found.problems.empty()) {
    found.verdict = MeshInspection::Verdict::usable;
  }
  return found;
}

const char* to_string(MeshInspection::Verdict verdict) noexcept {
  switch (verdict) {
    case MeshInspection::Verdict::ok:
      return "ok";
    case MeshInspection::Verdict::usable:
      return "usable";
    case MeshInspection::Verdict::unusable:
      break;
  }
  return "unusable";
}

}  // namespace vicinity
