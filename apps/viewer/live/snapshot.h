// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// One tick of the live arm, as the pages see it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "live/drive.h"
#include "live/tick_times.h"
#include "vicinity/teleop/tick.h"

namespace vicinity::viewer {

struct Snapshot {
  std::uint32_t generation = 0;  ///< of the field that was felt
  std::uint32_t number = 0;
  double time_s = 0;  ///< since the loop began
  std::uint64_t ticks = 0, skipped = 0, missed = 0, refused = 0;
  DriveMode drive = DriveMode::hold;
  std::uint8_t limiter_mode = 0;  ///< 0 none, else LimiterMode + 1
  AxisVector q, qd;               ///< that the tick was given
  Output output;                  ///< that it gave back
  double scale = 1;               ///< of the limiter; 1 where there is none
  Pose tool = Pose::Identity();   ///< X_WT
  Vec3 v_WT = Vec3::Zero();       ///< of the tool's origin [m/s]
  std::vector<Pose> links;        ///< X_WL
  double felt = 0, lag = 0;       ///< as Hand has them
  Vec3 pulled_to = Vec3::Zero();  ///< in W [m]
  std::vector<PointDrag> points;  ///< of the points shown
  TickTimes::LastSecond last_second;
  std::array<std::uint32_t, TickTimes::bins> histogram{};
  double recording_s = std::numeric_limits<double>::quiet_NaN();  ///< time in what is followed
};

}  // namespace vicinity::viewer
