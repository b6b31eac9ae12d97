// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "intake.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "replay/arm.h"
#include "replay/felt_messages.h"
#include "ros2/cdr.h"

namespace vicinity::bridge {
namespace {

// Two clocks drift apart by less than a millisecond in so long.
constexpr std::int64_t window_ns = 5'000'000'000;
constexpr auto latest_ns = static_cast<std::int64_t>(1e9 * Intake::latest_s);

bool is_nan(double number) { return std::isnan(number); }

}  // namespace

const char* to_string(Heard heard) noexcept {
  switch (heard) {
    case Heard::state:
      return "state";
    case Heard::no_field:
      return "no field";
    case Heard::nothing_yet:
      return "nothing yet";
    case Heard::silence:
      return "silence";
    case Heard::late:
      return "late";
    case Heard::another_robot:
      return "another robot";
    case Heard::malformed:
      return "malformed";
  }
  return "unknown";
}

Intake::Intake(const RobotModel& robot, const Pose& X_WB)
    : base_link_(robot.links.front().name), X_WB_(X_WB) {
  for (std::size_t c = 0; c < robot.coordinates.size(); ++c) {
    joints_.push_back(cli::joint_name(robot, c));
  }
}

std::optional<ArmSample> Intake::joint_state(std::span<const std::byte> bytes,
                                             const Arrival& arrived) {
  ArmSample sample;
  sample.X_WB = X_WB_;
  sample.stamp = cli::stamp_of(static_cast<std::uint64_t>(arrived.since_1970_ns));
  sample.heard = Heard::malformed;
  if (!ros2::read_cdr(bytes, state_)) return sample;
  find_joints();
  if (places_.empty() && started_) return {};
  if (state_.position.size() != state_.name.size() || state_.header.stamp.sec < 0) return sample;
  std::int64_t sent_ns = arrived.since_1970_ns;
  if (const std::uint64_t stamp_ns = cli::nanoseconds_of(state_.header.stamp); stamp_ns > 0) {
    sent_ns = static_cast<std::int64_t>(stamp_ns);
    sample.stamp = state_.header.stamp;
  }
  sample.heard = Heard::another_robot;
  if (places_.size() != joints_.size()) return sample;
  sample.heard = Heard::late;
  if (is_late(sent_ns, arrived.monotonic_ns)) return sample;
  sample.heard = Heard::state;
  if (!started_) first_ns_ = sent_ns;
  started_ = true;
  sample.time_s = 1e-9 * static_cast<double>(sent_ns - first_ns_);
  sample.has_velocities = state_.velocity.size() == state_.name.size();
  sample.q.resize(static_cast<Eigen::Index>(places_.size()));
  sample.qd = AxisVector::Zero(sample.q.size());
  for (std::size_t c = 0; c < places_.size(); ++c) {
    const auto n = static_cast<Eigen::Index>(c);
    sample.q[n] = state_.position[places_[c]];
    if (sample.has_velocities) sample.qd[n] = state_.velocity[places_[c]];
  }
  // So says ROS 2's broadcaster that the hardware measures none.
  if (std::any_of(sample.qd.begin(), sample.qd.end(), is_nan)) sample.has_velocities = false;
  return sample;
}

bool Intake::transforms(std::span<const std::byte> bytes, const std::string& world) {
  ros2::TFMessage message;
  if (!ros2::read_cdr(bytes, message)) return false;
  for (const ros2::TransformStamped& each : message.transforms) {
    if (each.header.frame_id != world || each.child_frame_id != base_link_) continue;
    const auto& [p, r] = each.transform;
    const Eigen::Quaterniond rotation(r.w, r.x, r.y, r.z);
    Pose X_WB = Pose::Identity();
    X_WB.translation() = Vec3(p.x, p.y, p.z);
    X_WB.linear() = rotation.normalized().toRotationMatrix();
    if (!X_WB.matrix().allFinite() || std::abs(rotation.norm() - 1) > 1e-3) return false;
    X_WB_ = X_WB;
  }
  return true;
}

bool Intake::is_late(std::int64_t sent_ns, std::int64_t arrived_ns) {
  const std::int64_t under_way = arrived_ns - sent_ns;
  // A sender's clock that was set back, or one stamp before this that was far ahead: what was
  // measured by it says nothing. The tick sees that time ran backwards.
  if (!started_ || sent_ns < last_ns_ - latest_ns) {
    quickest_ = quickest_before_ = {};
    window_begin_ns_ = arrived_ns;
  } else if (arrived_ns - window_begin_ns_ > window_ns) {
    quickest_before_ = std::exchange(quickest_, {});
    window_begin_ns_ = arrived_ns;
  }
  last_ns_ = sent_ns;
  quickest_.second = std::min(quickest_.second, std::max(quickest_.first, under_way));
  quickest_.first = std::min(quickest_.first, under_way);
  const std::int64_t quickest = std::min(quickest_.second, quickest_before_.second);
  return quickest != Quickest::none && under_way - quickest > latest_ns;
}

void Intake::find_joints() {
  if (state_.name == names_) return;
  names_ = state_.name;
  places_.clear();
  for (const std::string& joint : joints_) {
    const auto found = std::ranges::find(names_, joint);
    if (found == names_.end()) continue;
    places_.push_back(static_cast<std::size_t>(found - names_.begin()));
  }
}

}  // namespace vicinity::bridge
