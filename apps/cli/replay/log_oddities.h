// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What is odd about a joint log: put right where that is safe, and always said.
#pragma once

#include <cstddef>
#include <vector>

#include "replay/joint_log.h"
#include "vicinity/robot/robot_model.h"

namespace vicinity::cli {

/// A continuous joint's angle that steps by more than half a turn between two samples has wrapped
/// around: whole turns are put back.
void unwrap_continuous_joints(const RobotModel& robot, JointLog& log);

/// Gaps, and sampling so slow that the time must be in another unit.
/// @param lines      of the file that the samples stand in, shape (samples,)
/// @param converted  whether the log or the user named the unit of its times
void remark_on_times(const std::vector<std::size_t>& lines, bool converted, JointLog& log);

/// Joints beyond their limits, or far faster than they can be.
void remark_on_motion(const RobotModel& robot, JointLog& log);

}  // namespace vicinity::cli
