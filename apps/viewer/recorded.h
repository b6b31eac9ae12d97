// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Recordings of `vicinity replay`, and joint logs, as the page plays them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "replay/joint_log.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/robot/robot_model.h"
#include "web/outbox.h"

namespace vicinity::viewer {

struct Recorded {
  std::string name;
  std::size_t rows_in_file = 0;
  std::vector<double> t;  ///< from 0, rising, shape (rows,) [s]
  std::vector<std::string> columns;
  std::vector<std::vector<double>> values;  ///< by column; NaN where the file has nothing

  /// From this row on, until the next.
  struct StatusChange {
    std::size_t row = 0;
    std::string status;
  };
  struct ReasonChange {
    std::size_t row = 0;
    std::string link, object;  ///< link empty: nothing is felt; object empty: only remembered
    double rank = 0, distance_mm = 0;
  };
  std::vector<StatusChange> statuses;
  std::vector<ReasonChange> reasons;

  /// Joint positions of every row, for the robot; absent where the file has not all of them.
  std::optional<cli::JointLog> motion;
};

/// Reads a CSV (or an MCAP recording, as read_log_text()) with a column `t` or `time`; joint
/// positions are `q_<joint>` or `<joint>`. Of more than 20,000 rows every second is left out, until
/// there are no more. Errors: throws Error for a file that cannot be read, without time or with
/// time that does not rise, with fewer than two rows, or with more than 256 columns.
Recorded read_recorded(const std::filesystem::path& path, const std::string& name,
                       const RobotModel& robot);

/// RECORDING. @param number  what FOLLOW calls it
SharedBytes recorded_message(std::uint32_t id, const Recorded& recorded, std::uint32_t number,
                             const RobotModel& robot, const Pose& X_WB);

}  // namespace vicinity::viewer
