// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// How much of the view triangles take up.
#pragma once

#include <cmath>
#include <numbers>

#include "vicinity/geometry/vec3.h"

namespace vicinity {

/// Sum of the signed solid angles of triangles seen from the origin, each positive where its outer
/// side faces away, and zero for an origin in its plane (van Oosterom and Strackee 1983).
///
/// Half of each angle is the argument of a complex number. Their product has the sum as its
/// argument, so that one arc tangent is enough for all of them; full turns are counted apart.
class SolidAngleSum {
 public:
  void add(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
    const double im = a.dot(b.cross(c));
    if (im == 0) return;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double re = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    const double product_re = re_ * re - im_ * im;
    const double product_im = re_ * im + im_ * re;
    // Two arguments of one sign whose sum is beyond pi come out with the other sign.
    if (im_ >= 0 && im > 0 && product_im < 0) ++turns_;
    if (im_ < 0 && im < 0 && product_im >= 0) --turns_;
    re_ = product_re;
    im_ = product_im;
    if (const double size = std::abs(re_) + std::abs(im_); size > 1e100 || size < 1e-100) {
      re_ /= size;
      im_ /= size;
    }
  }

  double value() const noexcept {
    return 2 * (std::atan2(im_, re_) + 2 * std::numbers::pi * turns_);
  }

 private:
  double re_ = 1, im_ = 0;
  int turns_ = 0;
};

}  // namespace vicinity
