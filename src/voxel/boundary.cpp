// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// How `exact` finds the voxels of one triangle. A layer k is a slice of the triangle, a row j a
// slice of that slice; what is left is convex, so its voxels in the row are one run:
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

#include "vicinity/voxel/boundary.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "slabbed_mesh.h"
#include "surface_voxels.h"

namespace vicinity {
namespace {

// Interpolating along an edge rounds at most nine times by 2^-53 of the farthest coordinate.
constexpr double rounding = 0x1p-49;

struct Point {
  double x, y;
  bool open;  // only approached by the slice, not part of it
};

// Marks the voxels of one triangle after another within one slab.
class TriangleTracer {
 public:
  TriangleTracer(VoxelSet& voxels, double reach)
      : voxels_(voxels), box_(voxels.box()), slack_(rounding * std::max(reach, 1.0)) {}

  // Marks the triangle's voxels in layers k_begin <= k < k_end.
  void trace(const std::array<Vec3, 3>& corners, std::int32_t k_begin, std::int32_t k_end) {
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    lo_ = {floor_index(low.x()), floor_index(low.y()), floor_index(low.z())};
    hi_ = {floor_index(high.x()), floor_index(high.y()), floor_index(high.z())};
    // Layers and rows beyond the box are left out before they cost anything: a floor is far larger
    // than the tiles it is voxelised in.
    first_row_ = std::max(lo_.j, box_.lo.j);
    last_row_ = std::min(hi_.j, box_.hi.j - 1);
    if (first_row_ > last_row_) return;
    k_begin = std::max({k_begin, lo_.k, box_.lo.k});
    k_end = std::min({k_end, hi_.k + 1, box_.hi.k});
    if (lo_.j == hi_.j && (lo_.k == hi_.k || lo_.i == hi_.i)) {
      for (std::int32_t k = k_begin; k < k_end; ++k) {
        voxels_.insert_run(lo_.i, hi_.i + 1, lo_.j, k);
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

 private:
  // From the lower end to the upper, so that triangles that share an edge cut it at the same point.
  struct Edge {
    Edge(const Vec3& a, const Vec3& b) : lower(a), upper(b) {
      if (std::array{b.z(), b.y(), b.x()} < std::array{a.z(), a.y(), a.x()}) {
        std::swap(lower, upper);
      }
    }
    Point at(double z, bool open) const {
      if (z == upper.z()) return {upper.x(), upper.y(), open};
      const double t = (z - lower.z()) / (upper.z() - lower.z());
      return {lower.x() + t * (upper.x() - lower.x()), lower.y() + t * (upper.y() - lower.y()),
              open};
    }
    Vec3 lower, upper;
  };

  struct Run {
    std::int32_t first = std::numeric_limits<std::int32_t>::max();
    std::int32_t last = std::numeric_limits<std::int32_t>::min();
  };

  // Walks the outline of the triangle's slice in layer k.
  void outline(const std::array<Edge, 3>& edges, std::int32_t k) {
    // Each plane is crossed by two edges or none: those from below it to it or above.
    std::array<Point, 3> bottom, top;
    std::size_t bottoms = 0, tops = 0;
    for (const Edge& edge : edges) {
      if (edge.upper.z() < k || edge.lower.z() >= k + 1) continue;
      const bool from_below = edge.lower.z() < k;
      const bool to_above = edge.upper.z() >= k + 1;
      const Point p = from_below ? edge.at(k, false) : Point{edge.lower.x(), edge.lower.y(), false};
      const Point q =
          to_above ? edge.at(k + 1, true) : Point{edge.upper.x(), edge.upper.y(), false};
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
  void touch_rows(const Point& p, double from_y) {
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
  void cross_rows(Point p, Point q, bool open) {
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
  void touch(std::int32_t j, double x, double low, double high, bool open) {
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
  void mark(std::int32_t k) {
    for (std::int32_t j = touched_first_; j <= touched_last_; ++j) {
      Run& run = rows_[static_cast<std::size_t>(j - first_row_)];
      // All open and all on one whole x: a plane along the grid, which is in the voxel above it.
      if (run.first <= hi_.i)
        voxels_.insert_run(run.first, std::max(run.first, run.last) + 1, j, k);
      run = {};
    }
    touched_first_ = std::numeric_limits<std::int32_t>::max();
    touched_last_ = std::numeric_limits<std::int32_t>::min();
  }

  VoxelSet& voxels_;
  VoxelBox box_;
  double slack_;
  VoxelIndex lo_, hi_;                 // of the triangle, both inside
  std::int32_t first_row_, last_row_;  // of the triangle within the box
  std::vector<Run> rows_;              // of the layer, from first_row_
  std::int32_t touched_first_ = std::numeric_limits<std::int32_t>::max();
  std::int32_t touched_last_ = std::numeric_limits<std::int32_t>::min();
};

VoxelSet exact_boundary(const SlabbedMesh& mesh) {
  VoxelSet voxels(mesh.box());
  tbb::parallel_for(mesh.slab_begin(), mesh.slab_end(), [&](std::int32_t slab) {
    TriangleTracer tracer(voxels, mesh.reach());
    for (const std::uint32_t t : mesh.triangles_in(slab)) {
      tracer.trace(mesh.corners(t), slab * 8, slab * 8 + 8);
    }
  });
  return voxels;
}

// Where the line parallel to axis `a` through (p_u, p_v) meets the triangle, if it does. Edges
// count as part of the triangle; each is looked at from the same end by both its triangles, so that
// no line slips between them.
class Probe {
 public:
  Probe(const std::array<Vec3, 3>& corners, int a) : corners_(corners), a_(a) {}

  std::optional<double> meet(double p_u, double p_v) const {
    const std::array sides{side(1, 2, p_u, p_v), side(2, 0, p_u, p_v), side(0, 1, p_u, p_v)};
    const bool within = std::ranges::all_of(sides, [](double s) { return s >= 0; }) ||
                        std::ranges::all_of(sides, [](double s) { return s <= 0; });
    const double area = sides[0] + sides[1] + sides[2];
    if (!within || area == 0) return std::nullopt;
    return corners_[0][a_] + sides[1] / area * (corners_[1][a_] - corners_[0][a_]) +
           sides[2] / area * (corners_[2][a_] - corners_[0][a_]);
  }

 private:
  // Twice the signed area between the edge and the line.
  double side(std::size_t from, std::size_t to, double p_u, double p_v) const {
    const int u = (a_ + 1) % 3, v = (a_ + 2) % 3;
    std::array p{corners_[from][u], corners_[from][v]}, q{corners_[to][u], corners_[to][v]};
    const bool turned = q < p;
    if (turned) std::swap(p, q);
    const double area = (q[0] - p[0]) * (p_v - p[1]) - (q[1] - p[1]) * (p_u - p[0]);
    return turned ? -area : area;
  }

  std::array<Vec3, 3> corners_;
  int a_;
};

// Grid lines through voxel centres, normal to the largest face of each triangle's bounding brick:
// along the brick's shortest side (§4.1.2). Among equal sides the first of z, y, x.
VoxelSet probe_boundary(const SlabbedMesh& mesh) {
  const VoxelBox& box = mesh.box();
  const std::array box_lo{box.lo.i, box.lo.j, box.lo.k}, box_hi{box.hi.i, box.hi.j, box.hi.k};
  VoxelSet voxels(box);
  for (const std::uint32_t t : mesh.triangles_listed()) {
    const std::array<Vec3, 3> corners = mesh.corners(t);
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    const Vec3 brick = high - low;
    const int a = brick.z() <= brick.y() && brick.z() <= brick.x() ? 2
                  : brick.y() <= brick.x()                         ? 1
                                                                   : 0;
    const int u = (a + 1) % 3, v = (a + 2) % 3;
    const Probe probe(corners, a);
    std::array<std::int32_t, 3> index;
    const auto first = [&](int axis) { return std::max(floor_index(low[axis]), box_lo[axis]); };
    const auto last = [&](int axis) { return std::min(floor_index(high[axis]), box_hi[axis] - 1); };
    for (index[v] = first(v); index[v] <= last(v); ++index[v]) {
      for (index[u] = first(u); index[u] <= last(u); ++index[u]) {
        const std::optional<double> met = probe.meet(index[u] + 0.5, index[v] + 0.5);
        if (!met) continue;
        index[a] = floor_index(std::clamp(*met, low[a], high[a]));
        const VoxelIndex voxel{index[0], index[1], index[2]};
        if (box.contains(voxel)) voxels.insert(voxel);
      }
    }
  }
  // A line that meets the surface within rounding of a voxel's face may end up on the wrong side.
  const VoxelSet exact = exact_boundary(mesh);
  VoxelSet both(mesh.box());
  voxels.for_each([&](const VoxelIndex& v) {
    if (exact.contains(v)) both.insert(v);
  });
  return both;
}

}  // namespace

VoxelSet surface_voxels(const SlabbedMesh& mesh, BoundaryMethod method) {
  return method == BoundaryMethod::exact ? exact_boundary(mesh) : probe_boundary(mesh);
}

VoxelSet boundary_voxels(const TriangleMesh& mesh, const Workspace& workspace,
                         BoundaryMethod method) {
  return surface_voxels(SlabbedMesh(mesh, workspace), method);
}

}  // namespace vicinity
