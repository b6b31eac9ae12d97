// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "lanes.h"

#include <cmath>

// One binary for every x86-64: the loader picks the widest vectors the processor has. Sanitizers do
// not bear code that runs before them, which is how the loader picks.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define VICINITY_WIDEST_VECTORS __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define VICINITY_WIDEST_VECTORS
#endif

namespace vicinity {
namespace {

constexpr std::size_t lanes = 8;

}  // namespace

VICINITY_WIDEST_VECTORS
void find_voxels(const float* x, const float* y, const float* z, std::size_t n, const GridMap& map,
                 std::int32_t* i, std::int32_t* j, std::int32_t* k,
                 std::uint8_t* changed) noexcept {
  const auto index = [](double g) noexcept {
    // floor() without a call where there is no instruction for it.
    const auto towards_zero = static_cast<std::int32_t>(g);
    return towards_zero - static_cast<std::int32_t>(g < towards_zero);
  };
  for (std::size_t p = 0; p < n; ++p) {
    const double px = x[p], py = y[p], pz = z[p];
    const std::int32_t vi =
        index(map.a[0][0] * px + map.a[0][1] * py + map.a[0][2] * pz + map.t[0]);
    const std::int32_t vj =
        index(map.a[1][0] * px + map.a[1][1] * py + map.a[1][2] * pz + map.t[1]);
    const std::int32_t vk =
        index(map.a[2][0] * px + map.a[2][1] * py + map.a[2][2] * pz + map.t[2]);
    changed[p] = static_cast<std::uint8_t>(((vi ^ i[p]) | (vj ^ j[p]) | (vk ^ k[p])) != 0);
    i[p] = vi;
    j[p] = vj;
    k[p] = vk;
  }
}

VICINITY_WIDEST_VECTORS
DragMoments sum_drag(const float* x, const float* y, const float* z, const float* w, std::size_t n,
                     const double* v, const double* omega) noexcept {
  double s[11][lanes] = {};
  double largest[lanes] = {}, largest_at[lanes] = {};
  for (std::size_t p = 0; p < n; p += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double px = x[p + lane], py = y[p + lane], pz = z[p + lane], pw = w[p + lane];
      const double qx = pw * px, qy = pw * py, qz = pw * pz;
      s[0][lane] += pw;
      s[1][lane] += qx;
      s[2][lane] += qy;
      s[3][lane] += qz;
      s[4][lane] += qx * px;
      s[5][lane] += qy * py;
      s[6][lane] += qz * pz;
      s[7][lane] += qx * py;
      s[8][lane] += qx * pz;
      s[9][lane] += qy * pz;
      const double vx = v[0] + omega[1] * pz - omega[2] * py;
      const double vy = v[1] + omega[2] * px - omega[0] * pz;
      const double vz = v[2] + omega[0] * py - omega[1] * px;
      const double force = pw * std::sqrt(vx * vx + vy * vy + vz * vz);
      s[10][lane] += force;
      const bool more = force > largest[lane];
      largest[lane] = more ? force : largest[lane];
      largest_at[lane] = more ? static_cast<double>(p + lane) : largest_at[lane];
    }
  }
  DragMoments sums;
  double* const into[11] = {&sums.w,   &sums.wx,  &sums.wy,  &sums.wz,  &sums.wxx,      &sums.wyy,
                            &sums.wzz, &sums.wxy, &sums.wxz, &sums.wyz, &sums.force_sum};
  for (std::size_t m = 0; m < 11; ++m) {
    for (std::size_t lane = 0; lane < lanes; ++lane) *into[m] += s[m][lane];
  }
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (largest[lane] > sums.force_largest) {
      sums.force_largest = largest[lane];
      sums.largest = static_cast<std::size_t>(largest_at[lane]);
    }
  }
  return sums;
}

}  // namespace vicinity
