// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The loops over all points of a cluster, many points at a time.
///
/// Written as loops over lanes that any compiler turns into vectors; the sums of the lanes are
/// added in a fixed order, so that every instruction set gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vicinity {

/// A voxel's index modulo 1024 along each axis, in the lower 30 bits of one word: enough to tell
/// whether a point has left its voxel, and for where, as long as it moves less than 512 voxels.
using VoxelKey = std::uint32_t;
inline constexpr int key_bits = 10;
inline constexpr std::int32_t key_span = 1 << key_bits;

/// Set in a key, no point is in its voxel any more.
inline constexpr VoxelKey left_voxel = 1u << 31;

constexpr VoxelKey key_of(std::int32_t i, std::int32_t j, std::int32_t k) noexcept {
  constexpr std::int32_t mask = key_span - 1;
  return static_cast<VoxelKey>((i & mask) | (j & mask) << key_bits | (k & mask) << 2 * key_bits);
}

/// p_grid = A p_LR + t, in single precision: a link's frame to voxels from a voxel whose index is a
/// multiple of key_span along each axis.
struct CoarseMap {
  float a[3][3];
  float t[3];
  float error = 0;  ///< of any coordinate of p_grid, at most [voxels]
};

/// Which points may have left the voxel of their key: all that have, and those too near to a face
/// for single precision to tell.
///
/// @param x,y,z  positions in the link's frame, shape (n,)
/// @param n      a multiple of 16, at most 64
/// @return       bit p is point p's
std::uint64_t find_moved(const float* x, const float* y, const float* z, const VoxelKey* key,
                         std::size_t n, const CoarseMap& map) noexcept;

/// Sums of w, w r, w r r' over points, with w = mu_e S and r their positions in the link's frame:
/// all that the drag on a rigid link needs, whatever its motion.
struct DragMoments {
  double w = 0;
  double wx = 0, wy = 0, wz = 0;
  double wxx = 0, wyy = 0, wzz = 0, wxy = 0, wxz = 0, wyz = 0;

  /// One point's w changes by this much.
  void add(double change, double x, double y, double z) noexcept {
    const double cx = change * x, cy = change * y, cz = change * z;
    w += change;
    wx += cx;
    wy += cy;
    wz += cz;
    wxx += cx * x;
    wyy += cy * y;
    wzz += cz * z;
    wxy += cx * y;
    wxz += cx * z;
    wyz += cy * z;
  }
  DragMoments& operator+=(const DragMoments& other) noexcept;
};

/// @param n  a multiple of 16
DragMoments sum_moments(const float* x, const float* y, const float* z, const float* w,
                        std::size_t n) noexcept;

/// The point that takes out most power, w |v + omega x r|².
struct MostPower {
  double power = 0;  ///< [W]
  std::size_t point = 0;
};

/// @param v,omega  of the link's frame, in the link's frame, shape (3,)
/// @param n        a multiple of 16
MostPower most_power(const float* x, const float* y, const float* z, const float* w, std::size_t n,
                     const double* v, const double* omega) noexcept;

/// One dyad w g g' for each point that comes nearer, with n the unit vector towards its surface and
/// g = (n, r x n): its force is -w (g . twist) n.
struct ClosingSums {
  double upper[21] = {};  ///< of the 6 x 6 sum, row by row from the diagonal on
  MostPower most;
  bool undirected = false;  ///< some point has drag, but no direction: it is in no sum
};

/// @param x,y,z     positions in the link's frame, shape (n,)
/// @param nx,ny,nz  towards the surface, in W, shape (n,); zero where not known
/// @param R_WL      row by row, shape (9,)
/// @param v,omega   of the link's frame, in W, shape (3,)
/// @param n         a multiple of 16
ClosingSums sum_closing(const float* x, const float* y, const float* z, const float* nx,
                        const float* ny, const float* nz, const float* w, std::size_t n,
                        const double* R_WL, const double* v, const double* omega) noexcept;

}  // namespace vicinity
