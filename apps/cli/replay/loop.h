// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The loop of a replay: a motion through the tick, as fast as it can or in real time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "progress_bar.h"
#include "replay/joint_trajectory.h"
#include "replay/real_time.h"
#include "replay/recording.h"
#include "vicinity/teleop/tick.h"

namespace vicinity::cli {

struct Pace {
  double rate = 1000;       ///< ticks per second [Hz]
  std::uint64_t ticks = 0;  ///< at most
  bool real_time = false;
};

struct LoopReport {
  bool interrupted = false;
  std::uint64_t skipped = 0;  ///< ticks whose time was over before they could begin
  double seconds = 0;         ///< that the loop took
  ProcessUse before, after;
  std::vector<std::string> granted;  ///< real time: as RealTime::words()
};

/// Ticks until the recording has `ticks` entries, a signal asks to end, or, in real time, their
/// time is over.
///
/// As fast as it can: tick k is at k/rate. In real time the loop sleeps until start + k/rate, and
/// time stamp and pose are those of the moment it wakes, as a controller's would be: a late tick is
/// seen as late by the tick itself. Ticks whose whole period has passed are skipped.
LoopReport run_loop(Teleoperation& teleoperation, const JointTrajectory& trajectory,
                    const Pose& X_WB, const Pace& pace, Recording& recording,
                    ProgressBar& progress);

}  // namespace vicinity::cli
