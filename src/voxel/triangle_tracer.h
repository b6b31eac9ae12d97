// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Every voxel of a triangle, by walking its outline: never in doubt, and not the fastest.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "slab_writer.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// What computed grid coordinates may be off by, relative to the farthest: interpolating along an
/// edge rounds at most nine times by 2^-53.
inline constexpr double rounding = 0x1p-49;

/// Marks the voxels of one triangle after another within one slab.
class TriangleTracer {
 public:
  /// @param box    outside which nothing is marked
  /// @param reach  largest absolute grid coordinate
  TriangleTracer(SlabWriter& slab, const VoxelBox& box, double reach);

  /// Marks the triangle's voxels in layers k_begin <= k < k_end of the slab.
  void trace(const std::array<Vec3, 3>& corners, std::int32_t k_begin, std::int32_t k_end);

 private:
  struct Point {
    double x, y;
    bool open;  // only approached by the slice, not part of it
  };
  struct Edge;
  struct Run {
    std::int32_t first = std::numeric_limits<std::int32_t>::max();
    std::int32_t last = std::numeric_limits<std::int32_t>::min();
  };

  void outline(const std::array<Edge, 3>& edges, std::int32_t k);
  void touch_rows(const Point& p, double from_y);
  void cross_rows(Point p, Point q, bool open);
  void touch(std::int32_t j, double x, double low, double high, bool open);
  void mark(std::int32_t k);

  SlabWriter& slab_;
  VoxelBox box_;
  double slack_;
  VoxelIndex lo_, hi_;                 // of the triangle, both inside
  std::int32_t first_row_, last_row_;  // of the triangle within the box
  std::vector<Run> rows_;              // of the layer, from first_row_
  std::int32_t touched_first_ = std::numeric_limits<std::int32_t>::max();
  std::int32_t touched_last_ = std::numeric_limits<std::int32_t>::min();
};

}  // namespace vicinity
