// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/boundary.h"

#include <algorithm>
#include <array>
#include <optional>

#include "few_voxels.h"
#include "geometry/whole_loops.h"
#include "row_axes.h"
#include "slab_writer.h"
#include "slabbed_mesh.h"
#include "surface_voxels.h"
#include "triangle_tracer.h"

namespace vicinity {
namespace {

// From this distance on rounding cannot move a voxel from one side of an axis to the other: far
// more than the grazing depth, and met by one triangle in some hundred thousand.
constexpr double sure_vox = 0x1p-24;

// Rows of as many in a layer are looked at all together.
constexpr std::int32_t few_rows = 8;

// Marks the voxels of one triangle after another within one slab: by separating axes, which answer
// for whole rows, and by tracing where those leave a doubt.
class TriangleMarker {
 public:
  TriangleMarker(VoxelSet& voxels, std::int32_t slab, double reach)
      : slab_(voxels, slab),
        tracer_(slab_, voxels.box(), reach),
        box_(voxels.box()),
        margin_(sure_vox + 32 * rounding * std::max(reach, 1.0)),
        k_begin_(slab * 8) {}

  void mark(const std::array<Vec3, 3>& corners) {
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    lo_ = {floor_index(low.x()), floor_index(low.y()), floor_index(low.z())};
    const VoxelIndex hi{floor_index(high.x()), floor_index(high.y()), floor_index(high.z())};
    // Layers and rows beyond the box are left out before they cost anything: a floor is far larger
    // than the tiles it is voxelised in.
    const std::int32_t first = std::max({k_begin_, lo_.k, box_.lo.k});
    const std::int32_t last = std::min({k_begin_ + 7, hi.k, box_.hi.k - 1});
    const RowAxes::Run rows = {std::max(box_.lo.j - lo_.j, 0),
                               std::min(hi.j, box_.hi.j - 1) - lo_.j};
    if (first > last || rows.first > rows.last) return;
    if ((lo_.i == hi.i) + (lo_.j == hi.j) + (lo_.k == hi.k) >= 2) {
      // A triangle is connected: it meets every voxel of a bounding box that is but one row.
      for (std::int32_t k = first; k <= last; ++k) {
        for (std::int32_t j = rows.first; j <= rows.last; ++j) slab_.put(lo_.i, hi.i, lo_.j + j, k);
      }
      return;
    }
    const bool is_small = std::max({hi.i - lo_.i, hi.j - lo_.j, hi.k - lo_.k}) == 1;
    if (is_small && box_.contains(lo_) && box_.contains(hi)) {
      unsigned voxels = 0;
      if (few_voxels(corners, lo_, voxels)) {
        // Those of the bounding box that are in the slab.
        voxels &= hi.i == lo_.i ? 0x55u : 0xffu;
        voxels &= hi.j == lo_.j ? 0x33u : 0xffu;
        voxels &= (first == lo_.k ? 0x0fu : 0u) | (last > lo_.k ? 0xf0u : 0u);
        slab_.put_cube(lo_, voxels);
        return;
      }
    }
    if (!axes_.set(corners, lo_, hi, margin_) || !mark_layers(first, last, rows)) {
      tracer_.trace(corners, first, last + 1);
    }
  }

 private:
  // Marks layers first <= k <= last; false where a voxel is in doubt. Rows count from lo_.j.
  bool mark_layers(std::int32_t first, std::int32_t last, const RowAxes::Run& box_rows) {
    if (box_rows.last - box_rows.first < few_rows) return mark_rows(first, last, box_rows);
    for (std::int32_t k = first; k <= last; ++k) {
      RowAxes::Run rows = axes_.rows_of_layer(k - lo_.k);
      rows = {std::max(rows.first, box_rows.first), std::min(rows.last, box_rows.last)};
      if (rows.first <= rows.last && !mark_rows(k, k, rows)) return false;
    }
    return true;
  }

  bool mark_rows(std::int32_t first, std::int32_t last, const RowAxes::Run& js) {
    std::array<std::int32_t, RowAxes::lanes> row_j, row_k;
    RowAxes::Rows rows;
    std::array<RowAxes::Run, RowAxes::lanes> runs;
    for (std::int32_t j = js.first, k = first; k <= last;) {
      for (std::size_t l = 0; l < RowAxes::lanes; ++l) {
        // Lanes that are left over repeat the one before.
        row_j[l] = k <= last ? j : row_j[l - 1];
        row_k[l] = k <= last ? k : row_k[l - 1];
        rows.j[l] = row_j[l];
        rows.k[l] = row_k[l] - lo_.k;
        if (++j > js.last) {
          j = js.first;
          ++k;
        }
      }
      if (!axes_.runs(rows, runs)) return false;
      for (std::size_t l = 0; l < RowAxes::lanes; ++l) {
        if (runs[l].first > runs[l].last) continue;
        slab_.put(lo_.i + runs[l].first, lo_.i + runs[l].last, lo_.j + row_j[l], row_k[l]);
      }
    }
    return true;
  }

  SlabWriter slab_;
  TriangleTracer tracer_;
  RowAxes axes_;
  VoxelBox box_;
  double margin_;
  std::int32_t k_begin_;
  VoxelIndex lo_;  // of the triangle
};

VoxelSet exact_boundary(const SlabbedMesh& mesh) {
  VoxelSet voxels(mesh.box());
  whole::parallel_for(mesh.slab_begin(), mesh.slab_end(), [&](std::int32_t slab) {
    TriangleMarker marker(voxels, slab, mesh.reach());
    for (const std::uint32_t t : mesh.triangles_in(slab)) marker.mark(mesh.corners(t));
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
