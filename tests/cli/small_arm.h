// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// An arm of three joints of three kinds, and a smooth motion of it past the small scene.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vicinity/geometry/vec3.h"

namespace vicinity::cli_test {

/// URDF: turn (continuous, about z), bend (revolute, about y), slide (prismatic, along x); about
/// 0.3 m long. Its faces lie on no face of the small scene's grid.
extern const char* const small_arm;

/// Where it stands so that the parabola takes it through ranks 3, 2 and 1 of the block.
extern const char* const small_arm_base;
Pose small_arm_X_WB();

/// Joint positions (turn, bend, slide) at a time.
using Motion = std::function<Vec3(double t)>;

/// q = a + b t + c t²: what interpolation by parabolas gives back exactly.
Vec3 parabola(double t);
Vec3 parabola_velocity(double t);

/// A log of a motion at these times: "t,turn,bend,slide".
std::string log_of(const Motion& motion, const std::vector<double>& times);

/// 0, 1/rate, 2/rate, ... up to the end.
std::vector<double> every(double rate, double end);

}  // namespace vicinity::cli_test
