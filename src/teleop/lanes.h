// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The two loops over all points that may be near something, eight points at a time.
///
/// Written as loops over lanes that any compiler turns into vectors; the sums of the lanes are
/// added in a fixed order, so that every instruction set gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vicinity {

/// p_grid = A p_LR + t: a link's frame to voxels from the workspace's origin.
struct GridMap {
  double a[3][3];
  double t[3];
};

/// Voxels that points are in.
///
/// @param x,y,z    positions in the link's frame, shape (n,); n a multiple of 8
/// @param i,j,k    in: voxels of the last tick; out: of this one, shape (n,)
/// @param changed  out, shape (n,): whether any of them differs
void find_voxels(const float* x, const float* y, const float* z, std::size_t n, const GridMap& map,
                 std::int32_t* i, std::int32_t* j, std::int32_t* k, std::uint8_t* changed) noexcept;

/// Sums of w, w r, w r r' over points, with w = mu_e S and r their positions: all that the drag on
/// a rigid link needs, whatever its motion. And which point feels the largest force w |v + omega x
/// r|.
struct DragMoments {
  double w = 0;
  double wx = 0, wy = 0, wz = 0;
  double wxx = 0, wyy = 0, wzz = 0, wxy = 0, wxz = 0, wyz = 0;
  double force_sum = 0, force_largest = 0;
  std::size_t largest = 0;
};

/// @param v,omega  of the link's frame, in the link's frame, shape (3,)
DragMoments sum_drag(const float* x, const float* y, const float* z, const float* w, std::size_t n,
                     const double* v, const double* omega) noexcept;

}  // namespace vicinity
