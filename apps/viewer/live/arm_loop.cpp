// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "live/arm_loop.h"

#include <sched.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <utility>

#include "replay/real_time.h"

namespace vicinity::viewer {
namespace {

constexpr double snapshots_per_s = 60;
constexpr std::size_t most_shown = 2048;
// What a period counts as at most where the machine stood still: the hand would leap [s].
constexpr double longest_period_s = 0.02;
// Nearer than this to the recording, the arm is on it [rad or m].
constexpr double on_the_recording = 1e-3;
// Above ordinary threads, below whatever else is real-time on this machine.
constexpr int modest_priority = 1;

std::vector<ArmLoop::ShownPoint> evenly_chosen(const BodyPoints& points) {
  std::vector<ArmLoop::ShownPoint> all;
  for (const BodyPoints::LinkRange& range : points.links) {
    for (std::uint32_t p = range.begin; p < range.end; ++p) all.push_back({p, range.link});
  }
  if (all.size() <= most_shown) return all;
  std::vector<ArmLoop::ShownPoint> chosen(most_shown);
  for (std::size_t n = 0; n < most_shown; ++n) chosen[n] = all[n * all.size() / most_shown];
  return chosen;
}

int tool_of(const RobotModel& robot, const TeleoperationOptions& options) {
  return options.tool_link >= 0 ? options.tool_link : static_cast<int>(robot.links.size()) - 1;
}

Drive standing_at(const AxisVector& q) {
  Drive drive;
  drive.q = q;
  return drive;
}

}  // namespace

ArmLoop::ArmLoop(const LoopArm& arm, const ViscosityField& field, std::uint32_t generation,
                 const TeleoperationOptions& options)
    : robot_(arm.robot),
      points_(arm.points),
      X_WB_(arm.X_WB),
      rate_(arm.rate),
      tool_link_(tool_of(arm.robot, options)),
      shown_(evenly_chosen(arm.points)),
      drives_(standing_at(arm.q)),
      snapshots_(empty_snapshot()),
      feeling_(std::make_unique<Feeling>(robot_, points_, field, generation, options)),
      drive_(standing_at(arm.q)),
      hand_(robot_, tool_link_, arm.q),
      kinematics_(robot_),
      torque_(AxisVector::Zero(arm.q.size())),
      recorded_qd_(AxisVector::Zero(arm.q.size())),
      times_(static_cast<std::size_t>(std::ceil(arm.rate))) {
  newest_ = &feeling_->teleoperation;
  kinematics_.update(hand_.q().data(), hand_.qd().data(), X_WB_);
  std::promise<bool> asked;
  std::future<bool> granted = asked.get_future();
  thread_ = std::thread([this, asked = std::move(asked)]() mutable {
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
    const sched_param priority{.sched_priority = modest_priority};
    asked.set_value(sched_setscheduler(0, SCHED_FIFO, &priority) == 0);
    run();
  });
  granted_ = granted.get() ? "scheduled before other programs (SCHED_FIFO)"
                           : "scheduled as other programs are: SCHED_FIFO was refused";
}

ArmLoop::~ArmLoop() {
  stop_.store(true);
  thread_.join();
}

bool ArmLoop::drive(const Drive& drive) {
  const bool sizes_fit = drive.q.size() == torque_.size() || drive.mode != DriveMode::joints;
  const double length = drive.R_WT.norm();
  if (!sizes_fit || !drive.q.allFinite() || !drive.p_WT.allFinite() || !(length > 1e-6) ||
      !std::isfinite(length) || drive.mode == DriveMode::follow) {
    return false;
  }
  const std::lock_guard lock(giving_);
  Drive& next = drives_.to_fill();
  next = drive;
  next.R_WT.normalize();
  if (drive.mode != DriveMode::joints) next.q = AxisVector::Zero(torque_.size());
  drives_.give();
  drives_given_.fetch_add(1, std::memory_order_relaxed);
  return true;
}

void ArmLoop::follow(std::unique_ptr<Following> following, std::uint64_t drives_before) {
  const std::lock_guard lock(giving_);
  if (drives() != drives_before) return;
  Drive& next = drives_.to_fill();
  next = standing_at(AxisVector::Zero(torque_.size()));
  if (following != nullptr) {
    next.mode = DriveMode::follow;
    followings_.offer(std::move(following));
  }
  drives_.give();
}

void ArmLoop::feel(const ViscosityField& field, std::uint32_t generation,
                   const TeleoperationOptions& options) {
  auto next = std::make_unique<Feeling>(robot_, points_, field, generation, options);
  const std::lock_guard lock(giving_);
  newest_ = &next->teleoperation;
  feelings_.offer(std::move(next));
}

void ArmLoop::recode(const ViscosityField& field) {
  const std::lock_guard lock(giving_);
  newest_->swap_field(field);
}

// As run_loop() of a replay in real time: a late tick is seen as late by the tick itself, and ticks
// whose whole period has passed are skipped.
void ArmLoop::run() noexcept {
  const double period_ns = 1e9 / rate_;
  const std::int64_t start = cli::monotonic_ns();
  for (std::uint64_t k = 1; !stop_.load(std::memory_order_relaxed);) {
    const auto due = static_cast<std::int64_t>(static_cast<double>(k) * period_ns);
    cli::sleep_until(start + due);
    const std::int64_t now = cli::monotonic_ns() - start;
    if (now < due) continue;  // a signal
    period(1e-9 * static_cast<double>(now), 1e-3 * static_cast<double>(now - due));
    const auto periods =
        static_cast<std::uint64_t>(static_cast<double>(cli::monotonic_ns() - start) / period_ns);
    const std::uint64_t next = std::max(periods, k + 1);
    skipped_ += next - (k + 1);
    k = next;
  }
}

void ArmLoop::period(double now_s, double late_us) noexcept {
  const double period_s = std::clamp(now_s - last_s_, 1e-6, longest_period_s);
  last_s_ = now_s;
  const Counts before = output_.counts;
  if (feelings_.take(feeling_)) {
    missed_before_ += before.missed_deadlines;
    refused_before_ += before.refused;
  }
  // A recording is given before the drive that asks for it: in this order none is missed.
  if (drives_.take()) drive_ = drives_.taken();
  followings_.take(following_);
  if (drive_.mode == DriveMode::follow) advance_recording(period_s);
  hand_.move(drive_, kinematics_, torque_, period_s);
  kinematics_.update(hand_.q().data(), hand_.qd().data(), X_WB_);

  const Input input{.time_s = now_s,
                    .q = hand_.q().data(),
                    .qd = hand_.qd().data(),
                    .joint_count = static_cast<int>(torque_.size()),
                    .X_WB = X_WB_};
  const std::int64_t begin = cli::monotonic_ns();
  (void)feeling_->teleoperation.tick(input, output_);  // the output holds its status
  const auto took = static_cast<double>(cli::monotonic_ns() - begin);
  times_.add(static_cast<float>(1e-3 * took), static_cast<float>(late_us));
  torque_ = output_.torque;
  ticks_done_.store(++ticks_, std::memory_order_relaxed);
  if (now_s >= next_snapshot_s_) {
    next_snapshot_s_ = std::max(next_snapshot_s_ + 1 / snapshots_per_s, now_s);
    fill_snapshot(now_s);
  }
}

void ArmLoop::advance_recording(double period_s) noexcept {
  if (following_ == nullptr) {
    drive_.mode = DriveMode::hold;
    return;
  }
  Following& recording = *following_;
  const double length = recording.trajectory.length_s();
  if (recording.playing && hand_.lag() <= on_the_recording + hand_.qd().norm() * period_s) {
    recording.time_s += recording.speed * period_s;
    if (recording.time_s > length) recording.time_s = recording.loop ? 0 : length;
    if (recording.time_s < 0) recording.time_s = recording.loop ? length : 0;
  }
  recording.trajectory.at(recording.time_s, drive_.q, recorded_qd_);
}

Snapshot ArmLoop::empty_snapshot() const {
  Snapshot empty;
  empty.links.resize(robot_.links.size(), Pose::Identity());
  empty.points.resize(shown_.size());
  return empty;
}

void ArmLoop::fill_snapshot(double now_s) noexcept {
  Snapshot& to = snapshots_.to_fill();
  to.generation = feeling_->generation;
  to.number = snapshots_made_++;
  to.time_s = now_s;
  to.ticks = ticks_;
  to.skipped = skipped_;
  to.missed = missed_before_ + output_.counts.missed_deadlines;
  to.refused = refused_before_ + output_.counts.refused;
  to.drive = drive_.mode;
  to.limiter_mode = feeling_->limiter_mode;
  to.q = hand_.q();
  to.qd = hand_.qd();
  to.output = output_;
  // There is a limiter, and it was asked.
  to.scale = output_.limiter.torque.size() > 0 ? output_.limiter.scale : 1;
  const auto tool = static_cast<std::size_t>(tool_link_);
  to.tool = kinematics_.X_WL(tool);
  to.v_WT = kinematics_.v_WLo(tool);
  for (std::size_t link = 0; link < to.links.size(); ++link)
    to.links[link] = kinematics_.X_WL(link);
  to.felt = drive_.mode == DriveMode::tool ? hand_.felt() : output_.tool.force.norm();
  to.lag = hand_.lag();
  to.pulled_to = hand_.pulled_to();
  // A tick that was refused has not moved the points.
  const Status status = output_.status;
  const bool fresh = status <= Status::deadline_missed || status == Status::not_passive;
  for (std::size_t n = 0; n < shown_.size(); ++n) {
    to.points[n] = fresh ? feeling_->teleoperation.point_drag(shown_[n].point) : PointDrag{};
  }
  to.last_second = times_.last_second();
  to.histogram = times_.histogram();
  const bool follows = drive_.mode == DriveMode::follow && following_ != nullptr;
  to.recording_s = follows ? following_->time_s : std::numeric_limits<double>::quiet_NaN();
  snapshots_.give();
}

}  // namespace vicinity::viewer
