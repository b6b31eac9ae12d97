// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "polygon.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace vicinity {
namespace {

/// Twice the area of the triangle a, b, c: positive where c lies left of the line from a to b.
double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool in_box_of(const PlanePoint& a, const PlanePoint& b, const PlanePoint& p) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

/// Whether the closed segments ab and cd share a point.
bool segments_meet(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c,
                   const PlanePoint& d) {
  const double abc = turn(a, b, c), abd = turn(a, b, d);
  const double cda = turn(c, d, a), cdb = turn(c, d, b);
  if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) &&
      ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0))) {
    return true;
  }
  return (abc == 0 && in_box_of(a, b, c)) || (abd == 0 && in_box_of(a, b, d)) ||
         (cda == 0 && in_box_of(c, d, a)) || (cdb == 0 && in_box_of(c, d, b));
}

}  // namespace

double signed_area(const std::vector<PlanePoint>& outline) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    twice += turn(outline[0], outline[i], outline[i + 1]);
  }
  return twice / 2;
}

bool is_simple(const std::vector<PlanePoint>& outline) {
  const std::size_t n = outline.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const PlanePoint &a = outline[i], &b = outline[(i + 1) % n], &c = outline[(i + 2) % n];
    // Neighbours share a corner by right; they must not share more by turning straight back.
    const double ahead = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);
    if (a == b || (turn(a, b, c) == 0 && ahead <= 0)) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if ((j + 1) % n == i) continue;
      if (segments_meet(a, b, outline[j], outline[(j + 1) % n])) return false;
    }
  }
  return true;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<PlanePoint>& outline) {
  std::vector<std::uint32_t> rest(outline.size());
  std::iota(rest.begin(), rest.end(), 0u);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto is_ear = [&](std::size_t i) {
    const std::size_t n = rest.size();
    const std::uint32_t before = rest[(i + n - 1) % n], tip = rest[i], after = rest[(i + 1) % n];
    const PlanePoint &a = outline[before], &b = outline[tip], &c = outline[after];
    if (!(turn(a, b, c) > 0)) return false;
    return std::none_of(rest.begin(), rest.end(), [&](std::uint32_t other) {
      if (other == before || other == tip || other == after) return false;
      // A corner on the cut from c to a counts as inside: it would leave a degenerate rest.
      const PlanePoint& p = outline[other];
      return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  };
  while (rest.size() > 3) {
    std::size_t ear = 0;
    while (ear < rest.size() && !is_ear(ear)) ++ear;
    // A simple polygon always has an ear; only rounding on near-degenerate outlines can hide it.
    if (ear == rest.size()) ear = 0;
    const std::size_t n = rest.size();
    triangles.push_back({rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({rest[0], rest[1], rest[2]});
  return triangles;
}

}  // namespace vicinity
