// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/felt_messages.h"

#include <fmt/format.h>

#include "replay/arm.h"

namespace vicinity::cli {
namespace {

constexpr std::uint64_t ns_per_second = 1'000'000'000;

ros2::Vector3 vector_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

ros2::Time stamp_of(std::uint64_t time_ns) {
  return {static_cast<std::int32_t>(time_ns / ns_per_second),
          static_cast<std::uint32_t>(time_ns % ns_per_second)};
}

std::uint64_t nanoseconds_of(const ros2::Time& stamp) {
  return static_cast<std::uint64_t>(stamp.sec) * ns_per_second + stamp.nanosec;
}

std::vector<std::string> object_names(const ViscosityField& field) {
  std::vector<std::string> names;
  for (const FieldObject& object : field.objects()) names.push_back(object.name);
  return names;
}

FeltMessages::FeltMessages(const RobotModel& robot, int tool_link)
    : kinematics_(robot),
      tool_link_(tool_link < 0 ? robot.links.size() - 1 : static_cast<std::size_t>(tool_link)),
      at_rest_(robot.coordinates.size()) {
  for (const Link& link : robot.links) links_.push_back(link.name);
  for (std::size_t c = 0; c < robot.coordinates.size(); ++c) {
    states_.name.push_back(joint_name(robot, c));
  }
  efforts_.name = states_.name;
  wrench_.header.frame_id = links_[tool_link_];
  ros2::DiagnosticStatus status;
  status.name = "vicinity: drag";
  status.hardware_id = robot.name;
  diagnostics_.status.push_back(status);
}

const ros2::JointState& FeltMessages::joint_states(const ros2::Time& stamp,
                                                   std::span<const double> q) {
  states_.header.stamp = stamp;
  states_.position.assign(q.begin(), q.end());
  return states_;
}

const ros2::JointState& FeltMessages::joint_efforts(const ros2::Time& stamp,
                                                    std::span<const double> torque) {
  efforts_.header.stamp = stamp;
  efforts_.effort.assign(torque.begin(), torque.end());
  return efforts_;
}

const ros2::WrenchStamped& FeltMessages::wrench(const ros2::Time& stamp, const Wrench& tool_W,
                                                std::span<const double> q, const Pose& X_WB) {
  kinematics_.update(q.data(), at_rest_.data(), X_WB);
  const Eigen::Matrix3d R_TW = kinematics_.R_WL(tool_link_).transpose();
  wrench_.header.stamp = stamp;
  wrench_.wrench.force = vector_of(R_TW * tool_W.force);
  wrench_.wrench.torque = vector_of(R_TW * tool_W.moment);
  return wrench_;
}

const ros2::DiagnosticArray& FeltMessages::diagnostics(const ros2::Time& stamp,
                                                       std::string_view status, std::byte level,
                                                       const Reason& reason) {
  diagnostics_.header.stamp = stamp;
  ros2::DiagnosticStatus& said = diagnostics_.status.front();
  said.level = level;
  said.message = status;
  said.values.clear();
  if (reason.link < 0) return diagnostics_;
  said.values.push_back({"link", links_[static_cast<std::size_t>(reason.link)]});
  if (reason.object < 0) return diagnostics_;
  said.values.push_back({"object", objects_[static_cast<std::size_t>(reason.object)]});
  said.values.push_back({"rank", std::to_string(reason.rank)});
  said.values.push_back({"distance_mm", fmt::format("{:.6g}", 1000 * reason.distance_m)});
  return diagnostics_;
}

std::byte FeltMessages::level_of(Status status) noexcept {
  return status >= Status::deadline_missed ? ros2::DiagnosticStatus::warn
                                           : ros2::DiagnosticStatus::ok;
}

}  // namespace vicinity::cli
