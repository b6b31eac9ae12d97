// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The drag on an arm by another route than the tick's: point by point, F = -mu S v (eq. 5), and
/// each joint's torque from how it alone would move the point.
#pragma once

#include <string>
#include <vector>

#include "replay/arm.h"
#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::two_machines {

struct Drag {
  std::vector<double> torque;  ///< shape (joints,) [N·m or N]
  /// How far another, equally good rounding may be: points that lie on the face between two voxels
  /// may be looked up in either.
  std::vector<double> slack;
};

/// Without memory, in the direction `all`, `sampled`, without a limiter.
class Oracle {
 public:
  explicit Oracle(const cli::Arm& arm);

  Drag drag(const ViscosityField& field, const std::vector<double>& q,
            const std::vector<double>& qd);

 private:
  const cli::Arm& arm_;
  std::vector<ForwardKinematics> unit_motions_;  // one for each joint, which alone moves at 1
};

/// Whether the torques are those, within rounding.
bool is(const std::vector<double>& torque, const Drag& drag);
bool is_zero(const std::vector<double>& torque);

}  // namespace vicinity::two_machines
