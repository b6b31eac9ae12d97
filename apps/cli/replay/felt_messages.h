// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a tick took and gave, as ROS 2 messages: the same in a recording and over a bridge.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ros2/messages.h"
#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/teleop/tick.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::cli {

/// @param time_ns  since the origin of its clock, >= 0, less than 2^31 s
ros2::Time stamp_of(std::uint64_t time_ns);
std::uint64_t nanoseconds_of(const ros2::Time& stamp);

/// Names of a field's objects, in their order.
std::vector<std::string> object_names(const ViscosityField& field);

/// For one arm. Messages are filled in place, so that their memory is used again.
class FeltMessages {
 public:
  /// @param tool_link  as in TeleoperationOptions; -1: the last one
  FeltMessages(const RobotModel& robot, int tool_link);

  /// Names of the objects that reasons are about from now on.
  void name_objects(std::vector<std::string> objects) { objects_ = std::move(objects); }

  /// Positions that the tick was given. @param q  shape (joints,) [rad or m]
  const ros2::JointState& joint_states(const ros2::Time& stamp, std::span<const double> q);
  /// @param torque  shape (joints,) [N·m or N]
  const ros2::JointState& joint_efforts(const ros2::Time& stamp, std::span<const double> torque);
  /// All drag, at the origin of the tool link and in its axes.
  /// @param tool_W  about the same point, in W [N], [N·m]
  const ros2::WrenchStamped& wrench(const ros2::Time& stamp, const Wrench& tool_W,
                                    std::span<const double> q, const Pose& X_WB);
  /// One status: its message is the status in words, its values link, object, rank and distance_mm
  /// of the point that contributed most, as far as they are known.
  /// @param status  in words
  const ros2::DiagnosticArray& diagnostics(const ros2::Time& stamp, std::string_view status,
                                           std::byte level, const Reason& reason);
  /// How serious a status is: a warning is a tick without force, an error never ours.
  static std::byte level_of(Status status) noexcept;

  /// After wrench(): of the pose it was given.
  const ForwardKinematics& kinematics() const noexcept { return kinematics_; }
  std::size_t tool_link() const noexcept { return tool_link_; }

 private:
  std::vector<std::string> links_, objects_;
  ForwardKinematics kinematics_;
  std::size_t tool_link_;
  std::vector<double> at_rest_;
  ros2::JointState states_, efforts_;
  ros2::WrenchStamped wrench_;
  ros2::DiagnosticArray diagnostics_;
};

}  // namespace vicinity::cli
