// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "arm_loop.h"

#include "replay/real_time.h"

namespace vicinity::bridge {
namespace {

constexpr auto silence_ns = static_cast<std::int64_t>(1e9 * ArmLoop::longest_silence_s);

}  // namespace

ArmLoop::ArmLoop(int joints) : joints_(joints) {
  thread_ = std::thread([this] { run(); });
}

ArmLoop::~ArmLoop() {
  stop_.store(true);
  came_.ring();
  thread_.join();
}

bool ArmLoop::give(const ArmSample& sample) noexcept {
  const bool taken = in_.push(sample);
  came_.ring();
  return taken;
}

bool ArmLoop::take(Answer& answer, std::int64_t longest_ns) noexcept {
  const std::int64_t until_ns = cli::monotonic_ns() + longest_ns;
  while (!out_.pop(answer)) {
    const std::int64_t left = until_ns - cli::monotonic_ns();
    if (left <= 0) return false;
    done_.wait(left);  // it may still ring for one that was taken
  }
  return true;
}

void ArmLoop::run() noexcept {
  ArmSample sample;  // the last one, or what stands for none
  Heard none = Heard::nothing_yet;
  std::int64_t heard_ns = cli::monotonic_ns();
  while (!stop_.load(std::memory_order_relaxed)) {
    while (in_.pop(sample)) {
      answer(sample);
      none = Heard::silence;
      heard_ns = cli::monotonic_ns();
    }
    const std::int64_t left = heard_ns + silence_ns - cli::monotonic_ns();
    if (left > 0) {
      came_.wait(left);
      continue;
    }
    sample.heard = none;
    answer(sample);
    heard_ns = cli::monotonic_ns();  // and again after as long
  }
}

void ArmLoop::answer(const ArmSample& sample) noexcept {
  answer_.sample = sample;
  Teleoperation* const teleoperation = teleoperation_.load(std::memory_order_acquire);
  if (sample.heard == Heard::state && teleoperation == nullptr) {
    answer_.sample.heard = Heard::no_field;
  }
  if (answer_.sample.heard == Heard::state) {
    const Input input{.time_s = sample.time_s,
                      .q = sample.q.data(),
                      .qd = sample.has_velocities ? sample.qd.data() : nullptr,
                      .joint_count = static_cast<int>(sample.q.size()),
                      .X_WB = sample.X_WB};
    (void)teleoperation->tick(input, answer_.output);  // the output holds its status
    fields_taken_.store(answer_.output.counts.fields_taken, std::memory_order_release);
  } else {
    const EnergyBalance energy = answer_.output.energy;
    answer_.output = {};
    answer_.output.torque = AxisVector::Zero(joints_);
    answer_.output.energy = energy;
  }
  // Where nobody takes answers, the newest are lost: the wire is slower than the arm.
  (void)out_.push(answer_);
  done_.ring();
}

}  // namespace vicinity::bridge
