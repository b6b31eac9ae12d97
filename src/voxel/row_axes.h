// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Voxels of a triangle by separating axes, a run for each row, wherever they leave no doubt.
#pragma once

#include <array>
#include <cstdint>

#include "vicinity/geometry/vec3.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// The separating axes of a triangle and a voxel as linear inequalities in the voxel's indices.
///
/// A triangle meets a closed voxel just where none of thirteen axes separates them (Akenine-Möller
/// 2001): the grid's three, which the triangle's bounding box answers, its normal, and the cross
/// products of its edges with the grid's axes, each of which compares the two as seen along one
/// grid axis (Schwarz and Seidel 2010). Within a row each inequality bounds the index along x from
/// below or above, or holds for all of the row or none: no voxel is looked at.
class RowAxes {
 public:
  static constexpr std::size_t lanes = 4;

  /// A row (j,k) relative to the triangle's lowest voxel, as numbers.
  struct Rows {
    std::array<double, lanes> j, k;
  };

  /// Voxels first <= i <= last, relative to the triangle's lowest voxel; none where last < first.
  struct Run {
    std::int32_t first, last;
  };

  /// @param corners  in grid coordinates
  /// @param lo, hi   lowest and highest voxel of the triangle's bounding box, both inside
  /// @param margin   distance in voxels below which nothing is sure; far above rounding errors
  /// @return         whether anything is sure. Not for slivers, nor where a side of the bounding
  ///                 box is near a plane of the grid.
  bool set(const std::array<Vec3, 3>& corners, const VoxelIndex& lo, const VoxelIndex& hi,
           double margin) noexcept;

  /// Runs of some rows. False where a voxel of them is in doubt.
  bool runs(const Rows& rows, std::array<Run, lanes>& runs) const noexcept;

  /// The rows of layer k that may have voxels; none where last < first.
  Run rows_of_layer(double k) const noexcept;

 private:
  // c + cj * j + ck * k, and what is in doubt about it.
  struct Plane {
    double c, cj, ck, doubt;
  };

  void add(double a, double aj, double ak, double a0, double margin) noexcept;
  void add_side(std::size_t u, std::size_t v, double area, const std::array<Vec3, 3>& p,
                double margin) noexcept;

  std::array<Plane, 8> lower_, upper_;  // i >= plane; i <= plane
  std::array<Plane, 11> whole_;         // plane >= 0 for the whole row
  std::size_t lowers_, uppers_, wholes_;
  double last_i_, last_j_;  // of the bounding box
};

}  // namespace vicinity
