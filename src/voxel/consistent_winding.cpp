// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "consistent_winding.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace vicinity {
namespace {

// Triangles in patches; each knows whether it is wound against the root of its patch.
class Patches {
 public:
  explicit Patches(std::size_t triangles)
      : parent_(triangles), against_parent_(triangles, 0), one_sided_(triangles, 0) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  // Root of the triangle's patch, and whether the triangle is wound against it.
  std::pair<std::uint32_t, bool> root(std::uint32_t t) {
    std::uint32_t top = t;
    bool against = false;
    for (; parent_[top] != top; top = parent_[top]) against ^= against_parent_[top] != 0;
    // Point everything on the way at the root.
    for (bool rest = against; parent_[t] != top && t != top;) {
      const bool own = against_parent_[t] != 0;
      against_parent_[t] = rest;
      t = std::exchange(parent_[t], top);
      rest ^= own;
    }
    return {top, against};
  }

  void join(std::uint32_t a, std::uint32_t b, bool against_each_other) {
    const auto [root_a, against_a] = root(a);
    const auto [root_b, against_b] = root(b);
    const bool against = against_a ^ against_b ^ against_each_other;
    if (root_a == root_b) {
      one_sided_[root_a] |= against;
      return;
    }
    parent_[root_b] = root_a;
    against_parent_[root_b] = against;
    one_sided_[root_a] |= one_sided_[root_b];
  }

  bool is_one_sided(std::uint32_t root) const { return one_sided_[root] != 0; }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<char> against_parent_, one_sided_;
};

struct Side {
  std::uint32_t low, high, triangle;
  bool downward;  // whether the triangle runs from high to low
};

}  // namespace

TriangleMesh consistently_wound(TriangleMesh mesh) {
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t from = mesh.triangles[t][c], to = mesh.triangles[t][(c + 1) % 3];
      if (from != to) sides.push_back({std::min(from, to), std::max(from, to), t, from > to});
    }
  }
  const auto edge = [](const Side& s) { return std::pair(s.low, s.high); };
  std::sort(sides.begin(), sides.end(),
            [&](const Side& a, const Side& b) { return edge(a) < edge(b); });
  Patches patches(triangles);
  for (std::size_t s = 0, end; s < sides.size(); s = end) {
    for (end = s + 1; end < sides.size() && edge(sides[end]) == edge(sides[s]);) ++end;
    if (end - s != 2) continue;
    patches.join(sides[s].triangle, sides[s + 1].triangle,
                 sides[s].downward == sides[s + 1].downward);
  }

  // Per patch: triangles wound as the root less those wound against it, and the way of its lowest
  // triangle, which decides where there are as many of both.
  using Corners = std::array<std::array<double, 3>, 3>;
  struct Vote {
    std::int64_t balance = 0;
    Corners lowest;
    bool lowest_against = false;
    bool any = false;
  };
  std::vector<Vote> votes(triangles);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const auto [root, against] = patches.root(t);
    Corners corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = mesh.vertices[mesh.triangles[t][c]];
      corners[c] = {p.x(), p.y(), p.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    Vote& vote = votes[root];
    vote.balance += against ? -1 : 1;
    if (!vote.any || corners < vote.lowest) {
      vote.lowest = corners;
      vote.lowest_against = against;
    }
    vote.any = true;
  }
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const auto [root, against] = patches.root(t);
    if (patches.is_one_sided(root)) continue;
    const Vote& vote = votes[root];
    const bool most_against = vote.balance == 0 ? vote.lowest_against : vote.balance < 0;
    if (against != most_against) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  return mesh;
}

}  // namespace vicinity
