// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The bodies of a MuJoCo model and their surfaces, for body points to be sampled from.
#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "vicinity/robot/robot_model.h"

namespace vicinity {

/// The body's own name, or "body 7".
std::string name_of_body(const mjModel& model, int body);

/// One link for each body, numbered as they are and all fixed to the world, for their shapes alone:
/// how bodies move is MuJoCo's business. Only bodies that can move, and count, have a surface.
/// @param counted  by name: these and what hangs on them; empty: all
/// Errors: throws Error, with the nearest name, for a body that is not there.
RobotModel surfaces_of(const mjModel& model, const std::vector<std::string>& counted);

}  // namespace vicinity
