// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What moves where no robot was given: a ball on three slides, the paper's single point R.
#pragma once

#include "vicinity/robot/body_points.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity::viewer {

/// Slides x, y and z over the whole workspace; links `slide_x`, `slide_y` and `ball`.
RobotModel probe_robot(const Workspace& workspace);

/// One body point in the middle of the ball, with 1 m² of surface, as in `vicinity trace`.
BodyPoints probe_points(const RobotModel& probe);

}  // namespace vicinity::viewer
