// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Drag on one body point R inside the viscosity layers (eq. 5): opposes motion, zero at rest,
/// never pushes. Both forces only take energy out: F . v <= 0 whatever the input.
#pragma once

#include "vicinity/geometry/vec3.h"

namespace vicinity {

/// Which part of the velocity drag opposes.
enum class DragDirection {
  all,      ///< the whole velocity, as the paper does
  closing,  ///< only the part that comes nearer to the surface: retreat and sliding are free
};

/// F = -mu_e * S * v (eq. 5).
///
/// @param mu_e  effective viscosity, >= 0       [N·s/m³]
/// @param area  surface S of the point, >= 0    [m²]
/// @param v_WR  velocity of R in W, shape (3,)  [m/s]
/// @return      force on R, in W, shape (3,)    [N]
/// Errors: none; input that is not finite is refused earlier, by whoever has it first.
/// Real-time: O(1), no allocation.
Vec3 drag_force(double mu_e, double area, const Vec3& v_WR) noexcept;

/// F = -mu_e * S * (v . n)n where v . n > 0, else zero: eq. (5) for the closing part of the
/// velocity. Never larger than drag_force().
///
/// @param towards_W  n, unit vector from R towards the surface, shape (3,); zero where that is not
///                   known: the whole velocity is opposed, since any of it might be closing
Vec3 closing_drag_force(double mu_e, double area, const Vec3& v_WR, const Vec3& towards_W) noexcept;

}  // namespace vicinity
