// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/loop.h"

#include <cmath>
#include <string>
#include <utility>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

const LoopOptions& checked(const LoopOptions& options, int axes) {
  const auto refuse = [](const char* what, const std::string& found, const std::string& expected) {
    throw Error(
        {.where = "teleoperation loop", .what = what, .found = found, .expected = expected});
  };
  checked(options.master);
  if (!(options.period_s > 0) || !std::isfinite(options.period_s)) {
    refuse("the period is not a positive number", std::to_string(options.period_s), "seconds");
  }
  if (options.slave_periods < 1) {
    refuse("the slave's period is no number of the master's", std::to_string(options.slave_periods),
           "1 or more");
  }
  if (options.encoder_step.size() != 0 &&
      (options.encoder_step.size() != axes || !(options.encoder_step.minCoeff() >= 0))) {
    refuse("the encoder steps do not fit the master's axes",
           std::to_string(options.encoder_step.size()) + " values",
           std::to_string(axes) + ", zero or more");
  }
  return options;
}

Eigen::MatrixXd damping_of(const LoopOptions& options, int axes) {
  return options.damping.size() > 0 ? options.damping : Eigen::MatrixXd::Zero(axes, axes);
}

}  // namespace

const char* to_string(Placement placement) noexcept {
  return placement == Placement::local ? "local" : "remote";
}

TeleoperationLoop::TeleoperationLoop(Lead lead, Aid& aid, const LoopOptions& options)
    : lead_(std::move(lead)),
      aid_(aid),
      options_(checked(options, lead_.axis_count())),
      there_(options.there, 1 / options.period_s),
      back_(options.back, 1 / options.period_s),
      audit_(damping_of(options, lead_.axis_count())) {
  const AxisVector x = AxisVector::Zero(lead_.axis_count());
  start(lead_.q(), x, 0);
}

void TeleoperationLoop::start(const AxisVector& q, const AxisVector& x,
                              std::uint64_t seed) noexcept {
  lead_.start(q, x);
  aid_.restart();
  there_.restart(seed_for(seed, 0));
  back_.restart(seed_for(seed, 1));
  audit_.reset();
  command_ = q;
  torque_ = AxisVector::Zero(q.size());
  aid_force_ = AxisVector::Zero(x.size());
  tick_ = {aid_force_, aid_force_};
  speed_scale_ = 1;
  aid_age_ = 0;
}

Input TeleoperationLoop::input(double time_s, const AxisVector& q) const noexcept {
  Input input;
  input.time_s = time_s;
  input.q = q.data();
  input.joint_count = static_cast<int>(q.size());
  input.X_WB = lead_.X_WB();
  return input;
}

const MasterTick& TeleoperationLoop::master(double time_s, const AxisVector& x) noexcept {
  AxisVector read = x;
  for (Eigen::Index a = 0; a < options_.encoder_step.size(); ++a) {
    const double step = options_.encoder_step[a];
    if (step > 0) read[a] = step * std::floor(x[a] / step);
  }
  lead_.follow(read, speed_scale_);
  there_.send(time_s, {time_s, lead_.q()});
  const Answer* const answer = back_.receive(time_s);
  if (answer != nullptr) torque_ = answer->torque;
  if (options_.placement == Placement::local) {
    const AidForce felt = aid_.feel(input(time_s, lead_.q()));
    aid_force_ = felt.force;
    speed_scale_ = felt.speed_scale;
  } else if (answer != nullptr && answer->felt) {
    aid_force_ = answer->aid;
    aid_age_ = 0;
  } else if (++aid_age_ >= options_.slave_periods) {
    // No force acts for longer than the period it was made in: late or lost messages are zero.
    aid_force_.setZero();
  }
  const MasterArm& arm = options_.master;
  tick_.aid = arm.torque_constant * arm.gain / arm.lever * aid_force_;
  tick_.reflected = lead_.to_master(torque_);
  tick_.reflected *= -arm.torque_constant / (arm.attenuation * arm.lever);
  const double size = tick_.reflected.norm();
  if (options_.reflected_limit > 0 && size > options_.reflected_limit) {
    tick_.reflected *= options_.reflected_limit / size;
  }
  audit_.record(time_s, x, tick_.aid);
  return tick_;
}

const AxisVector& TeleoperationLoop::slave(double time_s, const AxisVector& tau2) noexcept {
  const Leading* const led = there_.receive(time_s);
  if (led != nullptr) command_ = led->q;
  Answer answer{tau2, aid_force_, false};
  if (options_.placement == Placement::remote && led != nullptr) {
    const AidForce felt = aid_.feel(input(led->time_s, command_));
    answer.aid = felt.force;
    answer.felt = true;
    // A scaled motion is scaled where it is led: nothing of it waits for the way back.
    speed_scale_ = felt.speed_scale;
  }
  back_.send(time_s, answer);
  return command_;
}

}  // namespace vicinity
