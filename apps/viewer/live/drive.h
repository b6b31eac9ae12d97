// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What the arm is asked to do.
#pragma once

#include <cstdint>

#include "vicinity/geometry/vec3.h"
#include "vicinity/teleop/axes.h"

namespace vicinity::viewer {

/// Who leads the arm. The numbers are those of the protocol.
enum class DriveMode : std::uint8_t {
  hold = 0,    ///< nobody: it comes to rest where it is
  tool = 1,    ///< the tool is pulled towards a pose
  joints = 2,  ///< every joint is pulled towards a position
  follow = 3,  ///< a recording
};

struct Drive {
  DriveMode mode = DriveMode::hold;
  bool orientation_counts = false;  ///< tool: else it is kept as it was
  Vec3 p_WT = Vec3::Zero();         ///< tool [m]
  Eigen::Quaterniond R_WT = Eigen::Quaterniond::Identity();
  AxisVector q;  ///< joints, or the recording's of this moment; shape (coordinates,) [rad or m]
};

}  // namespace vicinity::viewer
