// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Where lines parallel to x cross a mesh, so that no crossing is lost or counted twice.
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "vicinity/geometry/vec3.h"

namespace vicinity {

/// Piece of a triangle in a plane of constant z, shape (2,) each end. Seen along the surface with
/// its outer side to the right, the piece goes from `from` to `to`.
struct SliceSegment {
  std::array<double, 2> from, to;
};

/// A line's passage through a mesh: where, and +1 out of the object, -1 into it (towards +x).
struct Crossing {
  double x;
  int sign;
};

/// A vertex in the plane counts as below it, as if the plane were lifted by nothing at all. The
/// triangles around an edge then agree whether it is cut, and compute the same point to the last
/// bit, so that the slices of a closed mesh are closed polygons.
inline std::optional<SliceSegment> slice(const std::array<Vec3, 3>& corners, double z) {
  const std::array above{corners[0].z() > z, corners[1].z() > z, corners[2].z() > z};
  if (above[0] == above[1] && above[1] == above[2]) return std::nullopt;
  SliceSegment segment{};
  for (std::size_t e = 0; e < 3; ++e) {
    const std::size_t next = (e + 1) % 3;
    if (above[e] == above[next]) continue;
    const Vec3& low = above[e] ? corners[next] : corners[e];
    const Vec3& high = above[e] ? corners[e] : corners[next];
    const double t = (z - low.z()) / (high.z() - low.z());
    (above[e] ? segment.from : segment.to) = {low.x() + t * (high.x() - low.x()),
                                              low.y() + t * (high.y() - low.y())};
  }
  return segment;
}

/// Where the line of constant y in the slice's plane crosses the segment; the same rule for ends.
inline std::optional<Crossing> cross(const SliceSegment& segment, double y) {
  const bool from_above = segment.from[1] > y;
  const bool to_above = segment.to[1] > y;
  if (from_above == to_above) return std::nullopt;
  const double t = (y - segment.from[1]) / (segment.to[1] - segment.from[1]);
  return Crossing{segment.from[0] + t * (segment.to[0] - segment.from[0]), to_above ? 1 : -1};
}

}  // namespace vicinity
