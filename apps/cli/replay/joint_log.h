// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A recorded motion: joint positions over time, as loggers write it.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "replay/column_map.h"
#include "vicinity/robot/robot_model.h"

namespace vicinity::cli {

struct JointLog {
  std::vector<double> t;  ///< rising, from whatever origin the log has, shape (samples,) [s]
  Eigen::MatrixXd q;      ///< positions, shape (joints, samples) [rad or m]
  Eigen::MatrixXd qd;     ///< velocities, same shape, or empty where the log has none
  std::vector<std::string> remarks = {};  ///< what is odd about it, one sentence each
};

/// Reads a log for a robot: CSV, or the joint states of an MCAP recording (.mcap), whose columns
/// mcap_as_csv() names. Where `columns` does not say which column is what, time is `t` or
/// `time`, a joint's position has the joint's name, its velocity `qd_` and the name; velocities are
/// taken if there is one for every joint. A unit in brackets behind a column's name ("Time [ms]",
/// "joint_1 (deg)") is heeded unless the map states a factor, and need not be part of the name.
///
/// A continuous joint that wraps around is unwrapped, and said so. Said too: gaps, joints beyond
/// their limits or far beyond their speed, and times that look like another unit's.
///
/// Errors: throws Error, with the line, for a missing or ambiguous column, a quantity that is no
/// joint's (naming the nearest), a unit that does not fit, a cell that is no finite number, a line
/// that is too short, time that does not rise, and fewer than two samples.
JointLog read_joint_log(const std::filesystem::path& path, const RobotModel& robot,
                        const ColumnMap& columns);

}  // namespace vicinity::cli
