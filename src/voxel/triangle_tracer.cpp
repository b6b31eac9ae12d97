// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A layer k is a slice of the triangle, a row j a slice of that slice; what is left is convex, so
// its voxels in the row are one run:
//
//      y                     the slice of layer k, and the runs of its rows
//      |        ______
//    j+2 - - - /- - - \- -
//      |      /    ####\##      row j+1: from the leftmost to the rightmost point of the slice's
//    j+1 - - /- - - - - -\-              outline within the row
//      |    /_____________\     row j
//      |
//
// The outline consists of pieces of the triangle's edges and of the two cuts at z = k and z = k+1.
// Each piece is walked through the rows, and gives each row its end points and its crossings with
// the planes between rows: leftmost and rightmost are always among those. No clipped polygon is
// ever built.
//
// Voxels are half-open, [k, k+1): a point on the cut at z = k+1, or on the upper side of a row, is
// only approached. Where such an open point has a coordinate that is exactly whole, the voxel
// beyond is not touched. A plane along the grid, or at 45 degrees to it, so gets a skin of one
// voxel. Coordinates that were computed and are not exactly whole count for both voxels within the
// rounding error: in doubt a voxel is marked.

#include "triangle_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid_mesh.h"

namespace vicinity {

// From the lower end to the upper, so that triangles that share an edge cut it at the same point.
struct TriangleTracer::Edge {
  Edge(const Vec3& a, const Vec3& b) : lower(a), upper(b) {
    if (std::array{b.z(), b.y(), b.x()} < std::array{a.z(), a.y(), a.x()}) {
      std::swap(lower, upper);
    }
  }
  Point at(double z, bool open) const {
    if (z == upper.z()) return {upper.x(), upper.y(), open};
    const double t = (z - lower.z()) / (upper.z() - lower.z());
    return {lower.x() + t * (upper.x() - lower.x()), lower.y() + t * (upper.y() - lower.y()), open};
  }
  Vec3 lower, upper;
};

TriangleTracer::TriangleTracer(SlabWriter& slab, const VoxelBox& box, double reach)
    : slab_(slab), box_(box), slack_(rounding * std::max(reach, 1.0)) {}

void TriangleTracer::trace(const std::array<Vec3, 3>& corners, std::int32_t k_begin,
                           std::int32_t k_end) {
  const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  lo_ = {floor_index(low.x()), floor_index(low.y()), floor_index(low.z())};
  hi_ = {floor_index(high.x()), floor_index(high.y()), floor_index(high.z())};
  first_row_ = std::max(lo_.j, box_.lo.j);
  last_row_ = std::min(hi_.j, box_.hi.j - 1);
  if (first_row_ > last_row_) return;
  k_begin = std::max({k_begin, lo_.k, box_.lo.k});
  k_end = std::min({k_end, hi_.k + 1, box_.hi.k});
  if (lo_.j == hi_.j && (lo_.k == hi_.k || lo_.i == hi_.i)) {
    for (std::int32_t k = k_begin; k < k_end; ++k) {
      slab_.put(lo_.i, hi_.i, lo_.j, k);
    }
    return;
  }
  const std::array edges{Edge(corners[0], corners[1]), Edge(corners[1], corners[2]),
                         Edge(corners[2], corners[0])};
  rows_.resize(std::max(rows_.size(), static_cast<std::size_t>(last_row_ - first_row_) + 1));
  for (std::int32_t k = k_begin; k < k_end; ++k) {
    outline(edges, k);
    mark(k);
  }
}

// Walks the outline of the triangle's slice in layer k.
void TriangleTracer::outline(const std::array<Edge, 3>& edges, std::int32_t k) {
  // Each plane is crossed by two edges or none: those from below it to it or above.
  std::array<Point, 3> bottom, top;
  std::size_t bottoms = 0, tops = 0;
  for (const Edge& edge : edges) {
    if (edge.upper.z() < k || edge.lower.z() >= k + 1) continue;
    const bool from_below = edge.lower.z() < k;
    const bool to_above = edge.upper.z() >= k + 1;
    const Point p = from_below ? edge.at(k, false) : Point{edge.lower.x(), edge.lower.y(), false};
    const Point q = to_above ? edge.at(k + 1, true) : Point{edge.upper.x(), edge.upper.y(), false};
    if (from_below) bottom[bottoms++] = p;
    if (to_above) top[tops++] = q;
    touch_rows(p, p.y);
    touch_rows(q, p.y);
    cross_rows(p, q, false);
  }
  if (bottoms == 2) cross_rows(bottom[0], bottom[1], false);
  if (tops == 2) cross_rows(top[0], top[1], true);
}

// Gives an end point of a piece to its row; `from_y` is where the piece comes from.
void TriangleTracer::touch_rows(const Point& p, double from_y) {
  const std::int32_t row = floor_index(p.y);
  if (p.y == row) {
    touch(p.open && from_y < p.y ? row - 1 : row, p.x, p.x - slack_, p.x + slack_, p.open);
    return;
  }
  for (std::int32_t j = floor_index(p.y - slack_); j <= floor_index(p.y + slack_); ++j) {
    touch(j, p.x, p.x - slack_, p.x + slack_, p.open);
  }
}

// Gives the points where a piece meets the planes between rows to the rows that it comes from and
// goes to.
void TriangleTracer::cross_rows(Point p, Point q, bool open) {
  if (q.y < p.y) std::swap(p, q);
  std::int32_t j = floor_index(p.y);
  if (j < p.y) ++j;
  j = std::max(j, first_row_);
  if (j > q.y || p.y == q.y) return;
  const double left = std::min(p.x, q.x), right = std::max(p.x, q.x);
  const double slack = slack_ * (1 + (right - left) / (q.y - p.y));
  for (const double end = std::min(q.y, last_row_ + 1.0); j <= end; ++j) {
    const double x = j == q.y ? q.x : p.x + (j - p.y) / (q.y - p.y) * (q.x - p.x);
    const double low = std::max(x - slack, left - slack_);
    const double high = std::min(x + slack, right + slack_);
    if (j > p.y) touch(j - 1, x, low, high, true);
    if (j < q.y) touch(j, x, low, high, open);
  }
}

// Widens the run of row j by x, which is exact where it is whole and else surely between low and
// high.
void TriangleTracer::touch(std::int32_t j, double x, double low, double high, bool open) {
  if (j < first_row_ || j > last_row_) return;
  std::int32_t first = floor_index(x), last = first;
  if (x == first) {
    if (open) --last;
  } else {
    first = floor_index(low);
    last = floor_index(high);
  }
  Run& run = rows_[static_cast<std::size_t>(j - first_row_)];
  run.first = std::min(run.first, std::clamp(first, lo_.i, hi_.i));
  run.last = std::max(run.last, std::clamp(last, lo_.i, hi_.i));
  touched_first_ = std::min(touched_first_, j);
  touched_last_ = std::max(touched_last_, j);
}

// Marks the runs in layer k and forgets them.
void TriangleTracer::mark(std::int32_t k) {
  for (std::int32_t j = touched_first_; j <= touched_last_; ++j) {
    Run& run = rows_[static_cast<std::size_t>(j - first_row_)];
    // All open and all on one whole x: a plane along the grid, which is in the voxel above it.
    if (run.first <= hi_.i) slab_.put(run.first, std::max(run.first, run.last), j, k);
    run = {};
  }
  touched_first_ = std::numeric_limits<std::int32_t>::max();
  touched_last_ = std::numeric_limits<std::int32_t>::min();
}

}  // namespace vicinity
