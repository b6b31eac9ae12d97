// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What the operator's hand has to bring up on the master's side (eq. 8-10, fig. 33).
#pragma once

namespace vicinity {

/// The master arm of fig. 33, one degree of freedom.
struct MasterArm {
  double mass = 0;             ///< M        [kg]
  double damping = 0;          ///< B        [N·s/m]
  double gain = 1;             ///< G of the drag, >= 0
  double attenuation = 1;      ///< A of the slave's own torque, > 0
  double lever = 1;            ///< L: from the joint's axis to the point of force, > 0 [m]
  double torque_constant = 1;  ///< lambda: torque of the actuator for each N·m asked, > 0
};

/// The arm as it is. Errors: throws Error for a value that is not finite or not as stated above.
const MasterArm& checked(const MasterArm& master);

/// lambda (G tau1 + tau2/A)/L: the third term of eq. 10, which the hand feels against itself; the
/// master pushes the hand with its negative.
///
/// @param tau1  synthesised drag, positive against a positive velocity: mu_e S v and its sum over
///              the body, as a torque about the slave's joint                       [N·m]
/// @param tau2  the slave's own torque: inertia, friction, contact                  [N·m]
/// @return      [N]
/// Passive as far as the drag goes: D of the limiter must then be what the master feels, with
/// G lambda/L and the ratio of master to slave velocity in it.
/// Real-time: O(1).
inline double master_force(const MasterArm& master, double tau1, double tau2) noexcept {
  return master.torque_constant * (master.gain * tau1 + tau2 / master.attenuation) / master.lever;
}

/// Fh = M x'' + B x' + lambda (G tau1 + tau2/A)/L: all the hand brings up (eq. 10) [N].
///
/// @param x_dotdot,x_dot  the master's acceleration [m/s²] and velocity [m/s]
inline double operator_force(const MasterArm& master, double x_dotdot, double x_dot, double tau1,
                             double tau2) noexcept {
  return master.mass * x_dotdot + master.damping * x_dot + master_force(master, tau1, tau2);
}

}  // namespace vicinity
