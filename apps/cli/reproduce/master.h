// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What the operator's hand feels: figure 34, and the dynamics claims of §3.1.1 with figure 2.
#pragma once

#include <string>
#include <vector>

#include "reproduce/item.h"
#include "reproduce/one_joint.h"
#include "reproduce/pass.h"

namespace vicinity::report {

/// Fig. 34: the force of the hand on a pass by the cone, split by eq. 10.
struct OperatorPass {
  Pass pass;
  std::vector<double> absorbed;  ///< by the drag, lambda G tau1 / L [N]
  std::vector<double> needed;    ///< Fh: all that the hand brings up [N]
};

std::vector<OperatorPass> operator_passes(const ViscosityField& field,
                                          const ViscosityField& distances);
std::vector<Check> check_fig34(const std::vector<OperatorPass>& slow_to_fast);
Outcome fig34(Workshop& workshop);

/// Runs of the same joint and operator with a force field, with drag, and with neither.
struct Duel {
  JointRun field, drag, alone;
};

/// All that is measured for §3.1.1.
struct DynamicsRuns {
  Duel slot;               ///< pushed off the middle of a narrow slot, no delay
  Duel slot_delayed;       ///< the same with a delay
  Duel edge;               ///< past the edge of an object at even pace
  Duel stop;               ///< into the zone, then standing still
  Duel lean;               ///< leaning on the object
  JointRun too_much_drag;  ///< the delayed slot with drag beyond what the mass bears
};

/// @param drag_law  force of drag from viscosity times area [N·s/m] and velocity [m/s]
DynamicsRuns run_dynamics(const ViscosityField& slot, const ViscosityField& post,
                          const std::function<double(double, double)>& drag_law);

/// F = -mu S v, in one dimension.
double drag_in_one_dimension(double mu_S, double v);

std::vector<Check> check_dynamics(const DynamicsRuns& runs);
Outcome dynamics(Workshop& workshop);

}  // namespace vicinity::report
