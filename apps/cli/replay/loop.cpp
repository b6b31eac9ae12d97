// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/loop.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

#include "interruption.h"

namespace vicinity::cli {
namespace {

// Shows how far the loop is, so that the loop need not.
class Watcher {
 public:
  Watcher(ProgressBar& bar, std::uint64_t ticks)
      : thread_([this, &bar, ticks](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            bar.show("replaying", static_cast<double>(done) / static_cast<double>(ticks));
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
          }
        }) {}

  std::atomic<std::uint64_t> done{0};

 private:
  std::jthread thread_;  // joined first
};

// One tick after the other, each with the pose of its time.
class Ticker {
 public:
  Ticker(Teleoperation& teleoperation, const JointTrajectory& trajectory, const Pose& X_WB,
         Recording& recording)
      : teleoperation_(teleoperation), trajectory_(trajectory), recording_(recording) {
    input_.X_WB = X_WB;
    input_.joint_count = teleoperation.joint_count();
  }

  void tick(double time_s, double late_us) noexcept {
    trajectory_.at(time_s, q_, qd_);
    input_.time_s = time_s;
    input_.q = q_.data();
    input_.qd = trajectory_.has_velocities() ? qd_.data() : nullptr;
    const std::int64_t before = monotonic_ns();
    (void)teleoperation_.tick(input_, output_);  // the output holds its status
    const auto took = static_cast<double>(monotonic_ns() - before);
    recording_.add(time_s, q_.data(), output_, late_us, 1e-3 * took);
  }

 private:
  Teleoperation& teleoperation_;
  const JointTrajectory& trajectory_;
  Recording& recording_;
  AxisVector q_, qd_;
  Input input_;
  Output output_;
};

void run_fast(Ticker& ticker, const Pace& pace, Watcher& watcher) {
  for (std::uint64_t k = 0; k < pace.ticks && !interruption_asked(); ++k) {
    ticker.tick(static_cast<double>(k) / pace.rate, 0);
    watcher.done.store(k, std::memory_order_relaxed);
  }
}

std::uint64_t run_in_real_time(Ticker& ticker, const Pace& pace, Watcher& watcher) {
  constexpr std::int64_t head_start_ns = 10'000'000;
  const double period_ns = 1e9 / pace.rate;
  const std::int64_t start = monotonic_ns() + head_start_ns;
  std::uint64_t skipped = 0;
  for (std::uint64_t k = 0; k < pace.ticks && !interruption_asked();) {
    const auto due = static_cast<std::int64_t>(static_cast<double>(k) * period_ns);
    sleep_until(start + due);
    const std::int64_t now = monotonic_ns() - start;
    if (now < due) continue;  // a signal
    ticker.tick(1e-9 * static_cast<double>(now), 1e-3 * static_cast<double>(now - due));
    watcher.done.store(k, std::memory_order_relaxed);
    const auto periods =
        static_cast<std::uint64_t>(static_cast<double>(monotonic_ns() - start) / period_ns);
    const std::uint64_t next = std::clamp(periods, k + 1, pace.ticks);
    skipped += next - (k + 1);
    k = next;
  }
  return skipped;
}

}  // namespace

LoopReport run_loop(Teleoperation& teleoperation, const JointTrajectory& trajectory,
                    const Pose& X_WB, const Pace& pace, Recording& recording,
                    ProgressBar& progress) {
  LoopReport report;
  Ticker ticker(teleoperation, trajectory, X_WB, recording);
  Watcher watcher(progress, pace.ticks);
  std::optional<RealTime> real_time;
  if (pace.real_time) report.granted = real_time.emplace().words();
  report.before = process_use();
  const std::int64_t begin = monotonic_ns();
  if (pace.real_time) {
    report.skipped = run_in_real_time(ticker, pace, watcher);
  } else {
    run_fast(ticker, pace, watcher);
  }
  report.seconds = 1e-9 * static_cast<double>(monotonic_ns() - begin);
  report.after = process_use();
  report.interrupted = interruption_asked();
  return report;
}

}  // namespace vicinity::cli
