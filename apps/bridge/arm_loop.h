// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The tick in a thread of its own, one for each state that comes; it never meets DDS.
///
///   wire -> [DDS] -> intake -> Queue -> [ tick ] -> Queue -> announcer -> [DDS] -> wire
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "intake.h"
#include "queue.h"
#include "vicinity/teleop/tick.h"

namespace vicinity::bridge {

/// One answer. Its force is zero unless a state was heard and ticked.
struct Answer {
  ArmSample sample;
  Output output;
};

class ArmLoop {
 public:
  /// No state for so long: the force is zero, and said so, until the next comes [s].
  static constexpr double longest_silence_s = 0.02;

  /// Starts, without a field to feel. @param joints  how many torques an answer has
  explicit ArmLoop(int joints);
  ~ArmLoop();
  ArmLoop(const ArmLoop&) = delete;
  ArmLoop& operator=(const ArmLoop&) = delete;

  /// For one thread. False where the loop is so far behind that there is no room.
  bool give(const ArmSample& sample) noexcept;
  /// Once, from any thread: from now on it ticks this one, alone. It outlives the loop.
  void feel(Teleoperation& teleoperation) noexcept { teleoperation_.store(&teleoperation); }
  /// As in Counts, of the last tick.
  std::uint64_t fields_taken() const noexcept { return fields_taken_.load(); }
  /// For one thread: the next answer within so long, or false.
  bool take(Answer& answer, std::int64_t longest_ns) noexcept;

 private:
  static constexpr std::size_t room = 256;

  void run() noexcept;
  void answer(const ArmSample& sample) noexcept;

  int joints_;
  std::atomic<Teleoperation*> teleoperation_{nullptr};
  std::atomic<std::uint64_t> fields_taken_{0};
  Queue<ArmSample, room> in_;
  Queue<Answer, room> out_;
  Bell came_, done_;
  Answer answer_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace vicinity::bridge
