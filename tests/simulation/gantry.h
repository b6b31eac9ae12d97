// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A gantry of three slides with a ball for a tool, above a block: small enough to know every
/// answer.
#pragma once

#include <string>

#include "simulation/task.h"
#include "simulation/workplace.h"

namespace vicinity {

inline constexpr double gantry_ball = 0.02;    // radius [m]
inline constexpr double gantry_tool_kg = 0.8;  // of what the last slide carries [kg]

/// URDF: slides along x, y, z; at zero the ball is at the origin of W. Without inertia where asked.
std::string gantry_urdf(bool with_inertia = true);
RobotModel gantry(bool with_inertia = true);

/// A block 0.3 m wide whose top is at z = 0, voxels of 10 mm, layers of 60 mm.
Scene block_scene();
/// Shared by all tests: it takes a while to build.
const Workplace& block_workplace();

/// Down onto the block, to stop 20 mm above it; and back up in haste.
std::vector<Task> block_tasks();

}  // namespace vicinity
