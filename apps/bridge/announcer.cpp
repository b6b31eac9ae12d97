// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "announcer.h"

#include <cmath>

#include "replay/real_time.h"
#include "ros2/topics.h"

namespace vicinity::bridge {
namespace {

// Slower than this, a tool says nothing about the drag it would meet [m/s].
constexpr double standing_still = 1e-3;
// Monitors take a source that is silent for some seconds for dead.
constexpr std::int64_t say_again_ns = 1'000'000'000;
constexpr auto longest_blind_ns = static_cast<std::int64_t>(1e9 * ArmLoop::longest_silence_s);

// A tick with its force: what is said of the arm is known.
bool is_felt(const Answer& answer) noexcept {
  return answer.sample.heard == Heard::state && answer.output.status <= Status::outside_field;
}

}  // namespace

double speed_scale(double drag, double half) noexcept { return half / (half + drag); }

const char* status_of(const Answer& answer) noexcept {
  return answer.sample.heard == Heard::state ? to_string(answer.output.status)
                                             : to_string(answer.sample.heard);
}

std::byte level_of(const Answer& answer) noexcept {
  switch (answer.sample.heard) {
    case Heard::state:
      return cli::FeltMessages::level_of(answer.output.status);
    case Heard::nothing_yet:
    case Heard::silence:
      return ros2::DiagnosticStatus::stale;
    case Heard::late:
      return ros2::DiagnosticStatus::warn;
    default:
      return ros2::DiagnosticStatus::error;
  }
}

Announcer::Announcer(dds::Participant& participant, const FieldInUse& field,
                     const RobotModel& robot, int tool_link, double half_speed_drag)
    : field_(field),
      messages_(robot, tool_link),
      kinematics_(robot),
      half_speed_drag_(half_speed_drag),
      wrench_(participant.writer<ros2::WrenchStamped>(ros2::topic::wrench)),
      efforts_(participant.writer<ros2::JointState>(ros2::topic::joint_efforts)),
      force_(participant.writer<ros2::Float64>(ros2::topic::master_force)),
      scale_topic_(participant.writer<ros2::Float64>(ros2::topic::speed_scale)),
      diagnostics_(participant.writer<ros2::DiagnosticArray>(ros2::topic::diagnostics)),
      last_q_(AxisVector::Zero(static_cast<Eigen::Index>(robot.coordinates.size()))) {}

void Announcer::announce(const Answer& answer) {
  const ArmSample& sample = answer.sample;
  const Output& output = answer.output;
  const char* status = status_of(answer);
  ++statuses_[status];
  if (named_.is_new(answer)) {
    messages_.name_objects(field_.objects(answer));
    said_.clear();
  }
  const std::int64_t now_ns = cli::monotonic_ns();
  find_scale(answer);
  if (is_felt(answer)) {
    felt_ns_ = now_ns;
  } else if (now_ns - felt_ns_ > longest_blind_ns || sample.heard == Heard::silence) {
    scale_ = 0;  // whatever comes in place of what could be felt, nothing is known of the arm
  }
  const std::span<const double> q(last_q_.data(), static_cast<std::size_t>(last_q_.size()));
  const std::span<const double> torque(output.torque.data(),
                                       static_cast<std::size_t>(output.torque.size()));
  put(wrench_, messages_.wrench(sample.stamp, output.tool, q, sample.X_WB));
  put(efforts_, messages_.joint_efforts(sample.stamp, torque));
  put(force_, ros2::Float64{output.master_force});
  put(scale_topic_, ros2::Float64{scale_});
  const Reason& reason = output.reason;
  const bool unchanged = said_ == status && said_reason_.link == reason.link &&
                         said_reason_.object == reason.object && said_reason_.rank == reason.rank;
  if (unchanged && now_ns - said_ns_ < say_again_ns) return;
  put(diagnostics_, messages_.diagnostics(sample.stamp, status, level_of(answer), reason));
  said_ = status;
  said_reason_ = reason;
  said_ns_ = now_ns;
}

// The drag that the tool met: the power it lost, by the square of its speed.
void Announcer::find_scale(const Answer& answer) {
  const ArmSample& sample = answer.sample;
  if (sample.heard != Heard::state || !sample.q.allFinite()) return;
  AxisVector qd = sample.qd;
  const double period_s = sample.time_s - last_time_s_;
  if (!sample.has_velocities) {
    qd.setZero();
    if (period_s > 0) qd = (sample.q - last_q_) / period_s;
  }
  last_q_ = sample.q;
  last_time_s_ = sample.time_s;
  if (!is_felt(answer)) return;  // for a while, what was said stands
  kinematics_.update(last_q_.data(), qd.data(), sample.X_WB);
  const double speed = kinematics_.v_WLo(messages_.tool_link()).norm();
  if (!std::isfinite(speed) || speed < standing_still) {
    if (scale_ == 0) scale_ = 1;  // heard for the first time, or again
    return;
  }
  scale_ = speed_scale(answer.output.power / (speed * speed), half_speed_drag_);
}

}  // namespace vicinity::bridge
