// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The arm that moves and feels: 1000 ticks a second in a thread of its own, which waits for
/// nobody.
///
///   pages -> drive --Latest--> [ hand -> kinematics -> tick ] --Latest--> snapshots -> pages
///            feel, field, recording --Handover-->
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "live/drive.h"
#include "live/hand.h"
#include "live/latest.h"
#include "live/snapshot.h"
#include "replay/joint_trajectory.h"
#include "vicinity/teleop/handover.h"
#include "vicinity/teleop/tick.h"

namespace vicinity::viewer {

/// A recording that the arm goes along. It first goes to where the recording is, and time stands
/// still until it is there.
struct Following {
  cli::JointTrajectory trajectory;
  double time_s = 0, speed = 1;
  bool loop = false, playing = true;
};

/// What the loop is made from. Taken over by nobody: the loop keeps copies.
struct LoopArm {
  const RobotModel& robot;
  const BodyPoints& points;
  Pose X_WB = Pose::Identity();
  double rate = 1000;  ///< [Hz]
  AxisVector q;        ///< where it starts, within the limits
};

class ArmLoop {
 public:
  /// Starts ticking. Errors: throws Error for options that do not fit the robot.
  ArmLoop(const LoopArm& arm, const ViscosityField& field, std::uint32_t generation,
          const TeleoperationOptions& options);
  ~ArmLoop();
  ArmLoop(const ArmLoop&) = delete;
  ArmLoop& operator=(const ArmLoop&) = delete;

  // From any threads. None waits for the loop, and the loop waits for none.

  /// The newest counts. Errors: false for a number that is not finite or a size that does not fit.
  bool drive(const Drive& drive);
  /// How many drives there were.
  std::uint64_t drives() const noexcept { return drives_given_.load(std::memory_order_relaxed); }
  /// Along a recording; null: no more. A drive that came meanwhile counts, and not this.
  /// @param drives_before  drives() when it was asked for
  void follow(std::unique_ptr<Following> following, std::uint64_t drives_before);
  /// Another field, or another way of feeling: memory and energy account start anew.
  /// Errors: throws Error for options that do not fit the robot; then nothing has changed.
  void feel(const ViscosityField& field, std::uint32_t generation,
            const TeleoperationOptions& options);
  /// The same voxels with other codings: everything else goes on.
  void recode(const ViscosityField& field);

  /// Whether there is a newer snapshot than the last time; for one reading thread.
  bool take_snapshot() noexcept { return snapshots_.take(); }
  const Snapshot& snapshot() const noexcept { return snapshots_.taken(); }

  /// Body points that snapshots are about: indices into BodyPoints, and the link of each.
  struct ShownPoint {
    std::uint32_t point = 0;
    int link = 0;
  };
  const std::vector<ShownPoint>& shown() const noexcept { return shown_; }
  int tool_link() const noexcept { return tool_link_; }
  std::uint64_t ticks() const noexcept { return ticks_done_.load(std::memory_order_relaxed); }
  /// What the system granted, as a sentence.
  const std::string& granted() const noexcept { return granted_; }

 private:
  /// A way of feeling, and the field it is about.
  struct Feeling {
    Feeling(const RobotModel& robot, const BodyPoints& points, const ViscosityField& field,
            std::uint32_t of, const TeleoperationOptions& options)
        : teleoperation(robot, points, field, options),
          generation(of),
          limiter_mode(options.limiter
                           ? static_cast<std::uint8_t>(1 + static_cast<int>(options.limiter->mode))
                           : std::uint8_t{0}) {}
    Teleoperation teleoperation;
    std::uint32_t generation;
    std::uint8_t limiter_mode;
  };

  void run() noexcept;
  void period(double now_s, double late_us) noexcept;
  void advance_recording(double period_s) noexcept;
  void fill_snapshot(double now_s) noexcept;
  Snapshot empty_snapshot() const;

  RobotModel robot_;
  BodyPoints points_;
  Pose X_WB_;
  double rate_;
  int tool_link_;
  std::vector<ShownPoint> shown_;

  // Between the threads.
  std::mutex giving_;  // among those that give; the loop never takes it
  Latest<Drive> drives_;
  std::atomic<std::uint64_t> drives_given_{0};
  Handover<Following> followings_;
  Handover<Feeling> feelings_;
  Teleoperation* newest_ = nullptr;  // of all that were offered: the one in use, or soon in use
  Latest<Snapshot> snapshots_;
  std::atomic<std::uint64_t> ticks_done_{0};
  std::atomic<bool> stop_{false};

  // The loop's own.
  std::unique_ptr<Feeling> feeling_;
  std::unique_ptr<Following> following_;
  Drive drive_;
  Hand hand_;
  ForwardKinematics kinematics_;
  Output output_;
  AxisVector torque_, recorded_qd_;
  TickTimes times_;
  double last_s_ = 0, next_snapshot_s_ = 0;
  std::uint64_t ticks_ = 0, skipped_ = 0, missed_before_ = 0, refused_before_ = 0;
  std::uint32_t snapshots_made_ = 0;

  std::string granted_;
  std::thread thread_;
};

}  // namespace vicinity::viewer
