// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// One operator, one task, one aid, once: the loop from hand to metal and back.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "simulation/method.h"
#include "simulation/operator.h"
#include "simulation/task.h"
#include "simulation/workplace.h"
#include "simulation/world.h"
#include "vicinity/teleop/loop.h"

namespace vicinity {

/// Under which circumstances.
struct Condition {
  double delay_s = 0;   ///< there and back [s]
  double jitter_s = 0;  ///< each way [s]
  double loss = 0;      ///< each way, 0..1
  Placement placement = Placement::local;
  Device device = study_device();
};

/// What became of it.
struct TrialResult {
  bool finished = false;  ///< the operator believed to be there before the task's limit
  bool touched = false;
  bool blew_up = false;     ///< the physics did: the trial counts as touched and not finished
  double impact_speed = 0;  ///< at the first touch, along its normal; zero without       [m/s]
  double peak_force = 0;    ///< of contact                                             [N]
  double overshoot_m = 0;   ///< of the tool beyond where it was to stop                  [m]
  double miss_m = 0;        ///< of the tool at the end, from where it was to be          [m]
  double time_s = 0;        ///< until he believed to be there
  double effort = 0;        ///< of the hand: its force over time                       [N·s]
  double clearance_m = 0;   ///< smallest, of any body point, at most the layers' reach   [m]
  double pushed_j = 0;      ///< work that the aid did on the hand where it pushed along  [J]
  double given_j = 0;       ///< most that the aid had given beyond what it had taken     [J]
  double given_beyond_device_j = 0;  ///< and beyond what the device's own damping ate       [J]
};

/// For recordings: called once a millisecond.
using TrialWatcher = std::function<void(double time_s, const AxisVector& q_slave)>;

/// One arm at one task with one aid; for one thread.
class Trial {
 public:
  /// @param place,task  outlive it
  Trial(const Workplace& place, const Task& task, const Method& method, const Condition& condition);

  /// A slow and perfect approach, for what it feels like at the wanted distance. Nothing for tasks
  /// that are not ended by feel.
  Training train();

  /// Same seed, same hand: whatever the aid, so that aids are compared on the same operators.
  TrialResult run(std::uint64_t seed, const Training& trained, const TrialWatcher& watch = nullptr);

  /// Of the last run, of a drag: the account of the tick itself. Null for other aids.
  const Output* last_tick() const noexcept;

 private:
  TrialResult go(const OperatorParameters& person, const Intent& intent, const Training& trained,
                 std::uint64_t seed, double limit_s, double* level_at_goal,
                 const TrialWatcher& watch);

  const Workplace& place_;
  const Task& task_;
  Method method_;
  Condition condition_;
  OperatorParameters person_;
  FittedAid aid_;
  TeleoperationLoop loop_;
  World world_;
  ArmDistance distance_;
};

}  // namespace vicinity
