// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "row_axes.h"

#include <algorithm>
#include <cmath>

#include "vicinity/geometry/widest_vectors.h"

namespace vicinity {
namespace {

// A factor of i this much smaller than the others moves an inequality by less than any margin.
constexpr double no_slope = 1e-14;

// Below this the triangle is seen as a point, about which the bounding box says all.
constexpr double no_size = 1e-100;

// A normal is a difference of products: beside products this much larger than it, it says little.
constexpr double row_sliver = 0x1p-48;

}  // namespace

// Adds a * i + aj * j + ak * k + a0 >= 0, in doubt within `margin`.
inline void RowAxes::add(double a, double aj, double ak, double a0, double margin) noexcept {
  const double size = std::abs(a) + std::abs(aj) + std::abs(ak);
  if (size < no_size) return;
  if (std::abs(a) < no_slope * size) {
    whole_[wholes_++] = {a0, aj, ak, margin * size + std::abs(a) * last_i_};
    return;
  }
  const double scale = -1 / a;
  const Plane bound{a0 * scale, aj * scale, ak * scale, margin * size * std::abs(scale)};
  (a > 0 ? lower_[lowers_++] : upper_[uppers_++]) = bound;
}

// Adds what separates the triangle and a voxel as seen along the axis across u and v: the normals
// of its sides, or, where it is seen edge-on, both sides of its longest.
inline void RowAxes::add_side(std::size_t u, std::size_t v, double area,
                              const std::array<Vec3, 3>& p, double margin) noexcept {
  const auto at = [](std::size_t axis) { return static_cast<Eigen::Index>(axis); };
  std::array<double, 3> along_u, along_v, length;
  for (std::size_t e = 0; e < 3; ++e) {
    along_u[e] = p[(e + 1) % 3][at(u)] - p[e][at(u)];
    along_v[e] = p[(e + 1) % 3][at(v)] - p[e][at(v)];
    length[e] = std::abs(along_u[e]) + std::abs(along_v[e]);
  }
  const auto inequality = [&](double nu, double nv, double from) {
    // The corner of the voxel that is farthest along (nu, nv) decides.
    std::array<double, 3> n{0, 0, 0};
    n[u] = nu;
    n[v] = nv;
    add(n[0], n[1], n[2], std::max(nu, 0.0) + std::max(nv, 0.0) - from, margin);
  };
  const double longest = std::max({length[0], length[1], length[2]});
  if (std::abs(area) < 0.25 * margin * longest) {
    const std::size_t e = length[0] == longest ? 0 : length[1] == longest ? 1 : 2;
    const double nu = -along_v[e], nv = along_u[e];
    std::array<double, 3> d;
    for (std::size_t c = 0; c < 3; ++c) d[c] = nu * p[c][at(u)] + nv * p[c][at(v)];
    inequality(nu, nv, std::min({d[0], d[1], d[2]}));
    inequality(-nu, -nv, -std::max({d[0], d[1], d[2]}));
    return;
  }
  const double turn = area > 0 ? 1 : -1;
  for (std::size_t e = 0; e < 3; ++e) {
    const double nu = -turn * along_v[e], nv = turn * along_u[e];
    inequality(nu, nv, nu * p[e][at(u)] + nv * p[e][at(v)]);
  }
}

VICINITY_WIDEST_VECTORS
bool RowAxes::set(const std::array<Vec3, 3>& corners, const VoxelIndex& lo, const VoxelIndex& hi,
                  double margin) noexcept {
  const Vec3 origin(lo.i, lo.j, lo.k);
  const std::array<Vec3, 3> p{corners[0] - origin, corners[1] - origin, corners[2] - origin};
  const Vec3 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
  const Vec3 high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
  const Vec3 last(hi.i - lo.i, hi.j - lo.j, hi.k - lo.k);
  const double near = 4 * margin;
  if (low.maxCoeff() > 1 - near || (high - last).minCoeff() < near) return false;

  const Vec3 e = p[1] - p[0], f = p[2] - p[0];
  const Vec3 n = e.cross(f);
  const double size = n.lpNorm<1>();
  const double products = e.cwiseAbs().sum() * f.cwiseAbs().sum();
  if (size * margin < row_sliver * products * (1 + last.sum())) return false;

  lowers_ = uppers_ = wholes_ = 0;
  last_i_ = last.x();
  last_j_ = last.y();
  const double d = n.dot(p[0]);
  add(n.x(), n.y(), n.z(), n.cwiseMax(0).sum() - d, margin);
  add(-n.x(), -n.y(), -n.z(), d - n.cwiseMin(0).sum(), margin);
  add_side(0, 1, n.z(), p, margin);
  add_side(1, 2, n.x(), p, margin);
  add_side(2, 0, n.y(), p, margin);
  return true;
}

VICINITY_WIDEST_VECTORS
bool RowAxes::runs(const Rows& rows, std::array<Run, lanes>& runs) const noexcept {
  using Lanes = std::array<double, lanes>;
  Lanes sure, likely;
  sure.fill(1);
  likely.fill(1);
  for (std::size_t n = 0; n < wholes_; ++n) {
    const Plane& w = whole_[n];
    for (std::size_t l = 0; l < lanes; ++l) {
      const double value = w.c + w.cj * rows.j[l] + w.ck * rows.k[l];
      sure[l] = std::min(sure[l], value - w.doubt);
      likely[l] = std::min(likely[l], value + w.doubt);
    }
  }
  Lanes first_sure, first_likely, last_sure, last_likely;
  first_sure.fill(0);
  first_likely.fill(0);
  last_sure.fill(last_i_);
  last_likely.fill(last_i_);
  for (std::size_t n = 0; n < lowers_; ++n) {
    const Plane& bound = lower_[n];
    for (std::size_t l = 0; l < lanes; ++l) {
      const double i = bound.c + bound.cj * rows.j[l] + bound.ck * rows.k[l];
      first_sure[l] = std::max(first_sure[l], i + bound.doubt);
      first_likely[l] = std::max(first_likely[l], i - bound.doubt);
    }
  }
  for (std::size_t n = 0; n < uppers_; ++n) {
    const Plane& bound = upper_[n];
    for (std::size_t l = 0; l < lanes; ++l) {
      const double i = bound.c + bound.cj * rows.j[l] + bound.ck * rows.k[l];
      last_sure[l] = std::min(last_sure[l], i - bound.doubt);
      last_likely[l] = std::min(last_likely[l], i + bound.doubt);
    }
  }
  bool no_doubt = true;
  for (std::size_t l = 0; l < lanes; ++l) {
    // Rounded up and down among the indices of the box, and one beyond for none.
    const auto up = [&](double x) {
      const double within = std::min(x, last_i_ + 1);
      const auto whole = static_cast<std::int32_t>(within);
      return whole + (whole < within ? 1 : 0);
    };
    const auto down = [&](double x) {
      return static_cast<std::int32_t>(std::max(x, -1.0) + 1) - 1;
    };
    const Run widest{up(first_likely[l]), down(last_likely[l])};
    const Run surest{up(first_sure[l]), down(last_sure[l])};
    const bool none = likely[l] < 0 || widest.last < widest.first;
    no_doubt &= none || (sure[l] > 0 && widest.first == surest.first && widest.last == surest.last);
    runs[l] = none ? Run{0, -1} : widest;
  }
  return no_doubt;
}

RowAxes::Run RowAxes::rows_of_layer(double k) const noexcept {
  double first = 0, last = last_j_;
  for (std::size_t n = 0; n < wholes_; ++n) {
    const Plane& w = whole_[n];
    const double here = w.c + w.ck * k + w.doubt;
    if (w.cj > 0) first = std::max(first, std::min(-here / w.cj, last_j_ + 1));
    if (w.cj < 0) last = std::min(last, std::max(-here / w.cj, -1.0));
  }
  // Rounding may be off by one either way, which costs a row without voxels.
  return {std::max(static_cast<std::int32_t>(first) - 1, 0),
          static_cast<std::int32_t>(std::min(last + 1, last_j_))};
}

}  // namespace vicinity
