// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "nearest_region.h"

namespace vicinity {
namespace {

/// How much a region is widened on top of what rounding asks for, in voxels.
constexpr double region_widening = 1e-4;

/// The error of n · (p - a) in single precision, by the length of p - a. Both vectors are rounded,
/// and so are three products and their sum: 2^-24 each, by at most sqrt(3) times the lengths.
constexpr double rounding = 4e-7;

}  // namespace

NearestRegion::NearestRegion(FeatureKind of_kind, const Vec3& at, double longest, double reach)
    : direction(Eigen::Vector3f::Zero()), kind(of_kind) {
  const Vec3 voxel = at.array().round();
  anchor = voxel.cast<float>();
  point = (at - voxel).cast<float>();
  // A box or cell that touches the region has its centre no more than a tile farther off.
  error = static_cast<float>(rounding * (longest + reach + 16));
}

void NearestRegion::keep_behind(const Vec3& normal, const Vec3& at, double longest, double slack) {
  x[planes] = static_cast<float>(normal.x());
  y[planes] = static_cast<float>(normal.y());
  z[planes] = static_cast<float>(normal.z());
  const Vec3 from_anchor = at - anchor.cast<double>();
  offset[planes] = static_cast<float>(
      normal.dot(from_anchor) + longest * (slack + region_widening + static_cast<double>(error)));
  ++planes;
}

void NearestRegion::set_bounds(const Box& feature, const Vec3& margin) {
  const Vec3 all = margin + Vec3::Constant(2 * region_widening + 2 * static_cast<double>(error));
  lo = (feature.min() - all).cast<float>();
  hi = (feature.max() + all).cast<float>();
}

}  // namespace vicinity
