// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// One joint of a master in the hand of an operator, driven by a computer: the setting in which
/// force field and drag are compared (§3.1.1).
///
///   m x'' + b x' = F + k (target - x) - c x'
///
/// The operator's hand is a spring k and a damper c towards where he wants to be. F is computed
/// once a period from a position that is `delay` periods old and from the difference of two such
/// positions, and held. Between two periods everything is linear: the motion is exact.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

namespace vicinity::report {

struct JointSetting {
  double mass = 0.3;           ///< m [kg]
  double damping = 1;          ///< b, the device's own [N·s/m]
  double grip_stiffness = 30;  ///< k [N/m]
  double grip_damping = 1;     ///< c [N·s/m]
  double period = 0.001;       ///< [s]
  int delay = 0;               ///< whole periods between measuring and acting
  double wall = INFINITY;      ///< a run ends where x passes this size: contact [m]
};

/// What the computer answers to a position [m] and a velocity [m/s]: a force on the joint [N].
using Feedback = std::function<double(double x, double v)>;

/// What the operator wants: a target [m] at a time [s].
using Target = std::function<double(double t)>;

struct JointInstant {
  double t = 0, x = 0, v = 0;
  double force = 0;  ///< held from now on
};

struct JointRun {
  std::vector<JointInstant> instants;
  double put_in = 0;       ///< energy of all periods in which the force drove the joint [J]
  double taken_out = 0;    ///< energy of all others, as a positive number [J]
  double gain = 0;         ///< the most that put_in ever was above taken_out [J]
  bool contact = false;    ///< ended at the wall
  double ripple = 0;       ///< peak to peak of x in the last quarter [m]
  int reversals = 0;       ///< how often the velocity changed its sign
  double final_force = 0;  ///< largest size of the force in the last quarter [N]
};

JointRun simulate(const JointSetting& setting, const Feedback& feedback, const Target& target,
                  double x, double v, double duration);

}  // namespace vicinity::report
