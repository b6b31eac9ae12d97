// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/drag.h"

#include <algorithm>

namespace vicinity {

Vec3 drag_force(double mu_e, double area, const Vec3& v_WR) noexcept {
  return -mu_e * area * v_WR;  // eq. (5)
}

Vec3 closing_drag_force(double mu_e, double area, const Vec3& v_WR,
                        const Vec3& towards_W) noexcept {
  if (towards_W.isZero(0)) return drag_force(mu_e, area, v_WR);
  const double closing_speed = std::max(0.0, v_WR.dot(towards_W));
  return drag_force(mu_e, area, closing_speed * towards_W);
}

}  // namespace vicinity
