// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/layers/distance_layers.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/whole_loops.h"
#include "sheet_distances.h"
#include "sheet_lists.h"
#include "surface_features.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

/// The box, grown to hold the voxels of all points in `bounds`.
VoxelBox hull(const VoxelBox& box, const Box& bounds) {
  if (bounds.isEmpty()) return box;
  const auto voxel = [](double centre) {
    return static_cast<std::int32_t>(std::floor(centre + 0.5));
  };
  const Vec3 &lo = bounds.min(), &hi = bounds.max();
  return {{std::min(box.lo.i, voxel(lo.x())), std::min(box.lo.j, voxel(lo.y())),
           std::min(box.lo.k, voxel(lo.z()))},
          {std::max(box.hi.i, voxel(hi.x()) + 1), std::max(box.hi.j, voxel(hi.y()) + 1),
           std::max(box.hi.k, voxel(hi.z()) + 1)}};
}

double checked_reach(int m, int q) {
  if (m < 1 || m > 8) {
    throw Error({.where = "m",
                 .what = "not a number of voxels per rank",
                 .found = std::to_string(m),
                 .expected = "1 to 8"});
  }
  if (q < 0 || q > 32) {
    throw Error({.where = "q",
                 .what = "not a number of ranks",
                 .found = std::to_string(q),
                 .expected = "0 to 32"});
  }
  return q * m + half_diagonal_vox + distance_step_vox;
}

}  // namespace

struct SurfaceDistances::Parts {
  Parts(const TriangleMesh& mesh, const Workspace& workspace, int m_given, int q_given)
      : m(m_given),
        q(q_given),
        features(mesh, workspace, checked_reach(m, q)),
        of_sheets(features) {}

  int m, q;
  SurfaceFeatures features;
  SheetLists of_sheets;
};

SurfaceDistances::SurfaceDistances(const TriangleMesh& mesh, const Workspace& workspace, int m,
                                   int q)
    : parts_(std::make_unique<Parts>(mesh, workspace, m, q)) {}
SurfaceDistances::SurfaceDistances(SurfaceDistances&&) noexcept = default;
SurfaceDistances& SurfaceDistances::operator=(SurfaceDistances&&) noexcept = default;
SurfaceDistances::~SurfaceDistances() = default;

VoxelBox SurfaceDistances::box(const VoxelBox& boundary) const {
  // `probe` can leave parts of the surface a voxel outside of the boundary's box, and a centre
  // q*m + half_diagonal_vox away can lie a voxel beyond q*m voxels.
  if (boundary.empty() || parts_->q == 0) return boundary;
  return hull(boundary, parts_->features.bounds()).grown(parts_->q * parts_->m + 1);
}

DistanceLayers SurfaceDistances::layers(const VoxelSet& boundary, const VoxelSet& inner,
                                        const VoxelBox& within) const {
  const Parts& parts = *parts_;
  DistanceLayers layers{
      {std::vector<VoxelSet>(static_cast<std::size_t>(parts.q), VoxelSet(within))},
      BlockGrid<DistanceBlock>(within)};
  if (within.empty()) return layers;
  tbb::enumerable_thread_specific<SheetDistances> of_thread(
      [&] { return SheetDistances(parts.features, boundary, inner, parts.m, parts.q, layers); });
  const std::int32_t first = within.lo.k >> sheet_shift;
  const std::int32_t last = (within.hi.k - 1) >> sheet_shift;
  whole::parallel_for(first, last + 1, [&](std::int32_t sheet) {
    of_thread.local().fill(sheet, parts.of_sheets[sheet]);
  });
  return layers;
}

DistanceLayers distance_layers(const TriangleMesh& mesh, const VoxelSet& boundary,
                               const VoxelSet& inner, const Workspace& workspace, int m, int q) {
  const SurfaceDistances distances(mesh, workspace, m, q);
  return distances.layers(boundary, inner, distances.box(boundary.box()));
}

}  // namespace vicinity
