// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "nearest_region.h"

namespace vicinity {
namespace {

/// How much a region is widened on top of what rounding asks for, in voxels.
constexpr double region_widening = 1e-4;

/// The error of n · (p - a) in single precision, by the length of p - a: n is rounded, and so are
/// three products and their sum, each by at most 2^-24 of that length.
constexpr double rounding = 3e-7;

}  // namespace

NearestRegion::NearestRegion(FeatureKind of_kind, const Vec3& at, double longest, double reach)
    : direction(Eigen::Vector3f::Zero()), kind(of_kind) {
  const Vec3 voxel = at.array().round();
  anchor = voxel.cast<float>();
  point = (at - voxel).cast<float>();
  // Half a cell farther than any point of the region. Boxes have middles yet farther off, but not
  // by so much that the region_widening would not do for them.
  const double of_position = rounding * (longest + reach + 8);
  // An edge's foot is found along the edge, and then measured from.
  error = static_cast<float>(kind == FeatureKind::edge ? 2 * of_position : of_position);
}

void NearestRegion::keep_behind(const Vec3& normal, const Vec3& at, double slack) {
  x[planes] = static_cast<float>(normal.x());
  y[planes] = static_cast<float>(normal.y());
  z[planes] = static_cast<float>(normal.z());
  const double offset_there = normal.dot(at - anchor.cast<double>());
  offset[planes] =
      static_cast<float>(offset_there + slack + region_widening + static_cast<double>(error));
  ++planes;
}

void NearestRegion::set_doubt(double slack) {
  doubt = static_cast<float>(2 * (slack + region_widening + static_cast<double>(error)));
}

Eigen::AlignedBox3f NearestRegion::bounds(const Box& feature, const Vec3& margin) const {
  const Vec3 all = margin + Vec3::Constant(2 * region_widening + 2 * static_cast<double>(error));
  return {(feature.min() - all).cast<float>(), (feature.max() + all).cast<float>()};
}

}  // namespace vicinity
