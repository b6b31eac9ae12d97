// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Where one feature of a surface can be nearest, in single precision.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vicinity/geometry/vec3.h"

namespace vicinity {

/// A sliver is a face with a corner so sharp that its widened sides meet far beyond it.
enum class FeatureKind : std::uint8_t { face, sliver, edge, vertex };

/// A convex region around one feature, between planes. Lengths are voxels, and positions are told
/// from a voxel centre near the feature, so that single precision serves.
///
/// Single precision is only trusted as far as its error is known: planes are moved outwards by more
/// than it can move them inwards.
struct alignas(64) NearestRegion {
  static constexpr std::size_t most_planes = 7;

  NearestRegion() = default;
  /// @param at       a point of the feature, in grid coordinates
  /// @param longest  how far the feature reaches from there
  NearestRegion(FeatureKind of_kind, const Vec3& at, double longest, double reach);

  /// Leaves out what lies in front of the plane through `at`.
  /// @param normal  no longer than `longest`
  /// @param slack   how far in front of the plane the region may still reach
  void keep_behind(const Vec3& normal, const Vec3& at, double longest, double slack);

  /// Bounds the region by the feature's own and a margin along each axis.
  void set_bounds(const Box& feature, const Vec3& margin);

  /// Whether p is in the region; p in grid coordinates, and a voxel centre, so that it is exact.
  bool holds(const Eigen::Vector3f& p) const noexcept {
    return touches(p, Eigen::Vector3f::Zero());
  }

  /// False where one plane alone leaves a box out, given by its middle and half its size.
  bool touches(const Eigen::Vector3f& middle, const Eigen::Vector3f& half) const noexcept {
    const Eigen::Vector3f from = middle - anchor;
    for (std::size_t n = 0; n < planes; ++n) {
      const Eigen::Vector3f normal(x[n], y[n], z[n]);
      if (normal.dot(from) > offset[n] + normal.cwiseAbs().dot(half)) return false;
    }
    return true;
  }

  /// Normals and offsets: holds p where normal · (p - anchor) <= offset. Unused ones are 0.
  float x[most_planes] = {}, y[most_planes] = {}, z[most_planes] = {}, offset[most_planes] = {};
  Eigen::Vector3f anchor;     ///< the voxel centre, in grid coordinates
  Eigen::Vector3f point;      ///< of the face, the edge (its start) or the vertex; from anchor
  Eigen::Vector3f direction;  ///< of the face: its normal; of the edge: along it; length 1
  float length = 0;           ///< of the edge
  float error = 0;            ///< how far off a position along `direction` can be
  std::uint8_t planes = 0;
  FeatureKind kind = FeatureKind::vertex;
  Eigen::Vector3f lo, hi;  ///< bounds, in grid coordinates
};

}  // namespace vicinity
