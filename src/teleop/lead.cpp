// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/lead.h"

#include <Eigen/Cholesky>
#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

// Added to the square of the Jacobian [m²]: a direction that the arm commands with a lever of less
// than a centimetre is given up gradually.
constexpr double damping = 1e-4;
// No joint goes farther in one step than 10 rad/s at 1 kHz: what is missing comes in the next.
constexpr double longest_step = 0.01;

std::size_t checked_tool(const RobotModel& robot, int tool_link) {
  const int links = static_cast<int>(robot.links.size());
  if (tool_link < links && tool_link >= -1) {
    return static_cast<std::size_t>(tool_link < 0 ? links - 1 : tool_link);
  }
  throw Error({.where = "lead",
               .what = "no such link",
               .found = std::to_string(tool_link),
               .expected = "less than " + std::to_string(links)});
}

// Half the sine of the turn from one orientation to the other, about its axis, in W: nearly the
// turn itself, where it is small.
Vec3 turn_between(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) noexcept {
  Vec3 turn = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) turn += 0.5 * from.col(axis).cross(to.col(axis));
  return turn;
}

}  // namespace

Jacobian link_jacobian(const RobotModel& robot, const ForwardKinematics& kinematics,
                       std::size_t link) noexcept {
  Jacobian jacobian = Jacobian::Zero(6, static_cast<Eigen::Index>(robot.coordinates.size()));
  const Vec3& p_W = kinematics.p_WL(link);
  while (link > 0) {
    const Joint& joint = robot.joints[link - 1];
    if (joint.coordinate >= 0) {
      const Vec3 axis_W = joint.multiplier * (kinematics.R_WL(link) * joint.axis_J);
      if (joint.type == JointType::prismatic) {
        jacobian.col(joint.coordinate).head<3>() += axis_W;
      } else {
        jacobian.col(joint.coordinate).head<3>() += axis_W.cross(p_W - kinematics.p_WL(link));
        jacobian.col(joint.coordinate).tail<3>() += axis_W;
      }
    }
    link = static_cast<std::size_t>(joint.parent);
  }
  return jacobian;
}

Lead::Lead(const RobotModel& robot, AxisKind axes, int tool_link, const Pose& X_WB)
    : robot_(robot),
      axes_(axes),
      tool_(checked_tool(robot, tool_link)),
      X_WB_(X_WB),
      kinematics_(robot) {
  const auto n = static_cast<Eigen::Index>(robot.coordinates.size());
  if (n < 1 || n > axis_capacity) {
    throw Error({.where = "robot '" + robot.name + "'",
                 .what = "not an arm that can be led",
                 .found = std::to_string(n) + " joints that move",
                 .expected = "1 to " + std::to_string(axis_capacity)});
  }
  lower_.resize(n);
  upper_.resize(n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const auto joint = static_cast<std::size_t>(robot.coordinates[static_cast<std::size_t>(c)]);
    lower_[c] = robot.joints[joint].limits.lower;
    upper_[c] = robot.joints[joint].limits.upper;
  }
  const AxisVector rest = AxisVector::Zero(n);
  const AxisVector x = AxisVector::Zero(axis_count());
  start(rest, x);
}

int Lead::axis_count() const noexcept {
  return axes_ == AxisKind::cartesian ? 3 : static_cast<int>(robot_.coordinates.size());
}

void Lead::start(const AxisVector& q, const AxisVector& x) noexcept {
  q_ = q;
  x_ = x;
  const AxisVector still = AxisVector::Zero(q.size());
  kinematics_.update(q_.data(), still.data(), X_WB_);
  p_WT_ = kinematics_.p_WL(tool_);
  R_WT_ = kinematics_.R_WL(tool_);
  if (axes_ == AxisKind::cartesian) step_to_pose();
}

void Lead::follow(const AxisVector& x, double scale) noexcept {
  const AxisVector moved = scale * (x - x_);
  x_ = x;
  if (axes_ == AxisKind::joints) {
    q_ = (q_ + moved).cwiseMax(lower_).cwiseMin(upper_);
    return;
  }
  p_WT_ += moved.head<3>();
  step_to_pose();
}

void Lead::step_to_pose() noexcept {
  const AxisVector still = AxisVector::Zero(q_.size());
  jacobian_ = link_jacobian(robot_, kinematics_, tool_);
  Eigen::Matrix<double, 6, 6> square = jacobian_.lazyProduct(jacobian_.transpose());
  square.diagonal().array() += damping;
  inverse_square_ = square.llt().solve(Eigen::Matrix<double, 6, 6>::Identity());
  Eigen::Matrix<double, 6, 1> missing;
  missing << p_WT_ - kinematics_.p_WL(tool_), turn_between(kinematics_.R_WL(tool_), R_WT_);
  const Eigen::Matrix<double, 6, 1> weights = inverse_square_ * missing;
  AxisVector step = AxisVector::Zero(q_.size());
  step = jacobian_.transpose().lazyProduct(weights);
  const double longest = step.cwiseAbs().maxCoeff();
  if (longest > longest_step) step *= longest_step / longest;
  q_ = (q_ + step).cwiseMax(lower_).cwiseMin(upper_);
  kinematics_.update(q_.data(), still.data(), X_WB_);
}

AxisVector Lead::to_master(const AxisVector& torque) const noexcept {
  if (axes_ == AxisKind::joints) return torque;
  const Eigen::Matrix<double, 6, 1> carried = jacobian_.lazyProduct(torque);
  const Eigen::Matrix<double, 6, 1> wrench = inverse_square_ * carried;
  return wrench.head<3>();
}

}  // namespace vicinity
