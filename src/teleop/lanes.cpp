// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "lanes.h"

#include <cstring>

#include "vicinity/geometry/widest_vectors.h"

namespace vicinity {
namespace {

constexpr std::size_t lanes = 8;

// Eight points at once, as GCC and Clang know them on every processor.
using Floats = float __attribute__((vector_size(lanes * sizeof(float))));
using Doubles = double __attribute__((vector_size(lanes * sizeof(double))));

// Eight bytes of 0 or 1 to eight bits, the first byte to the lowest.
std::uint64_t bits_of(const std::uint8_t* bytes) noexcept {
  std::uint64_t word = 0;
  for (std::size_t b = 0; b < 8; ++b) word |= std::uint64_t{bytes[b]} << (8 * b);
  return (word * 0x0102040810204080u) >> 56;
}

}  // namespace

VICINITY_WIDEST_VECTORS
std::uint64_t find_moved(const float* x, const float* y, const float* z, const VoxelKey* key,
                         std::size_t n, const CoarseMap& map) noexcept {
  const CoarseMap m = map;  // no store below can change it
  const float near = m.error, far = 1 - m.error;
  alignas(64) std::uint8_t moved[64] = {};
  for (std::size_t p = 0; p < n; ++p) {
    const float g[3] = {(m.a[0][0] * x[p] + m.a[0][1] * y[p]) + (m.a[0][2] * z[p] + m.t[0]),
                        (m.a[1][0] * x[p] + m.a[1][1] * y[p]) + (m.a[1][2] * z[p] + m.t[1]),
                        (m.a[2][0] * x[p] + m.a[2][1] * y[p]) + (m.a[2][2] * z[p] + m.t[2])};
    std::int32_t index[3];
    bool unsure = false;
    for (int axis = 0; axis < 3; ++axis) {
      // floor() without a call where there is no instruction for it.
      const auto towards_zero = static_cast<std::int32_t>(g[axis]);
      index[axis] =
          towards_zero - static_cast<std::int32_t>(g[axis] < static_cast<float>(towards_zero));
      const float within = g[axis] - static_cast<float>(index[axis]);
      unsure |= (within < near) | (within > far);
    }
    moved[p] = static_cast<std::uint8_t>(unsure | (key_of(index[0], index[1], index[2]) != key[p]));
  }
  std::uint64_t bits = 0;
  for (std::size_t b = 0; b < 8; ++b) bits |= bits_of(&moved[8 * b]) << (8 * b);
  return bits;
}

DragMoments& DragMoments::operator+=(const DragMoments& other) noexcept {
  w += other.w;
  wx += other.wx;
  wy += other.wy;
  wz += other.wz;
  wxx += other.wxx;
  wyy += other.wyy;
  wzz += other.wzz;
  wxy += other.wxy;
  wxz += other.wxz;
  wyz += other.wyz;
  return *this;
}

VICINITY_WIDEST_VECTORS
DragMoments sum_moments(const float* x, const float* y, const float* z, const float* w,
                        std::size_t n) noexcept {
  double s[10][lanes] = {};
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
    }
  }
  DragMoments sums;
  double* const into[10] = {&sums.w,   &sums.wx,  &sums.wy,  &sums.wz,  &sums.wxx,
                            &sums.wyy, &sums.wzz, &sums.wxy, &sums.wxz, &sums.wyz};
  for (std::size_t m = 0; m < 10; ++m) {
    for (std::size_t lane = 0; lane < lanes; ++lane) *into[m] += s[m][lane];
  }
  return sums;
}

VICINITY_WIDEST_VECTORS
MostPower most_power(const float* x, const float* y, const float* z, const float* w, std::size_t n,
                     const double* v, const double* omega) noexcept {
  const double v0 = v[0], v1 = v[1], v2 = v[2], o0 = omega[0], o1 = omega[1], o2 = omega[2];
  double most[lanes] = {}, most_at[lanes] = {};
  for (std::size_t p = 0; p < n; p += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double px = x[p + lane], py = y[p + lane], pz = z[p + lane];
      const double vx = v0 + o1 * pz - o2 * py;
      const double vy = v1 + o2 * px - o0 * pz;
      const double vz = v2 + o0 * py - o1 * px;
      const double power = static_cast<double>(w[p + lane]) * (vx * vx + vy * vy + vz * vz);
      const bool more = power > most[lane];
      most[lane] = more ? power : most[lane];
      most_at[lane] = more ? static_cast<double>(p + lane) : most_at[lane];
    }
  }
  MostPower best;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (most[lane] > best.power) {
      best = {.power = most[lane], .point = static_cast<std::size_t>(most_at[lane])};
    }
  }
  return best;
}

VICINITY_WIDEST_VECTORS
ClosingSums sum_closing(const float* x, const float* y, const float* z, const float* nx,
                        const float* ny, const float* nz, const float* w, std::size_t n,
                        const double* R_WL, const double* v, const double* omega) noexcept {
  // Too much at once for the compiler to see that eight points are alike: they are said to be.
  const auto load = [](const float* from, Doubles& to) {
    Floats floats;
    std::memcpy(&floats, from, sizeof floats);
    to = __builtin_convertvector(floats, Doubles);
  };
  Doubles s[21] = {};
  Doubles most = {}, most_at = {}, undirected = {};
  const Doubles none = {};
  Doubles at = {0, 1, 2, 3, 4, 5, 6, 7};
  for (std::size_t p = 0; p < n; p += lanes, at += static_cast<double>(lanes)) {
    Doubles px, py, pz, pw, g0, g1, g2;
    load(x + p, px);
    load(y + p, py);
    load(z + p, pz);
    load(w + p, pw);
    load(nx + p, g0);
    load(ny + p, g1);
    load(nz + p, g2);
    const Doubles rx = R_WL[0] * px + R_WL[1] * py + R_WL[2] * pz;
    const Doubles ry = R_WL[3] * px + R_WL[4] * py + R_WL[5] * pz;
    const Doubles rz = R_WL[6] * px + R_WL[7] * py + R_WL[8] * pz;
    const Doubles g[6] = {g0, g1, g2, ry * g2 - rz * g1, rz * g0 - rx * g2, rx * g1 - ry * g0};
    const Doubles closing = g[0] * v[0] + g[1] * v[1] + g[2] * v[2] + g[3] * omega[0] +
                            g[4] * omega[1] + g[5] * omega[2];
    const Doubles a = closing > none ? pw : none;
    undirected += g0 * g0 + g1 * g1 + g2 * g2 > none ? none : pw;
    const Doubles power = a * closing * closing;
    most_at = power > most ? at : most_at;
    most = power > most ? power : most;
    for (int row = 0, m = 0; row < 6; ++row) {
      const Doubles h = a * g[row];
      for (int column = row; column < 6; ++column, ++m) s[m] += h * g[column];
    }
  }
  ClosingSums sums;
  for (std::size_t m = 0; m < 21; ++m) {
    for (std::size_t lane = 0; lane < lanes; ++lane) sums.upper[m] += s[m][lane];
  }
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    sums.undirected |= undirected[lane] > 0;
    if (most[lane] > sums.most.power) {
      sums.most = {.power = most[lane], .point = static_cast<std::size_t>(most_at[lane])};
    }
  }
  return sums;
}

}  // namespace vicinity
