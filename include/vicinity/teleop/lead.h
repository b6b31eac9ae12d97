// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// How the master's position leads the slave's joints.
#pragma once

#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/teleop/axes.h"

namespace vicinity {

using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, axis_capacity>;

/// Twist of a link's origin, linear [m/s] above angular [rad/s] in W, for each rad/s or m/s of a
/// joint; shape (6, coordinates). The kinematics say where the arm is.
/// Real-time: O(depth of the link), no allocation.
Jacobian link_jacobian(const RobotModel& robot, const ForwardKinematics& kinematics,
                       std::size_t link) noexcept;

/// Joints: the master is an arm of the same kind, one axis for each joint of the slave. Cartesian:
/// its handle leads the slave's tool, one to one, and the tool keeps its orientation.
class Lead {
 public:
  /// @param tool_link  led by a handle; -1: the last one
  /// Errors: throws Error for a robot that cannot be led, and a link it does not have.
  Lead(const RobotModel& robot, AxisKind axes, int tool_link, const Pose& X_WB);

  int axis_count() const noexcept;

  /// The arm stands at q, and the master at x.
  void start(const AxisVector& q, const AxisVector& x) noexcept;

  /// Moves the lead on by `scale` times what the master has moved since, and finds the joints:
  /// joints by adding, a handle by one damped least-squares step towards the pose (Nakamura &
  /// Hanafusa 1986; Wampler 1986), which near a singularity lags rather than leaps. Joints stay
  /// within their limits.
  /// @param x  the master's position, shape (axis_count(),) [rad or m]
  /// Real-time: O(joints), no allocation.
  void follow(const AxisVector& x, double scale) noexcept;

  /// Where the slave's joints are led to, shape (joints,) [rad or m].
  const AxisVector& q() const noexcept { return q_; }
  /// The base of the slave, in W.
  const Pose& X_WB() const noexcept { return X_WB_; }
  /// Where the led tool is, for those joints, in W [m].
  Vec3 p_WT() const noexcept { return kinematics_.p_WL(tool_); }

  /// The force on the master's axes that a torque on the slave's joints amounts to: itself, or the
  /// force at the tool that does the least-squares of it.
  AxisVector to_master(const AxisVector& torque) const noexcept;

 private:
  void step_to_pose() noexcept;

  RobotModel robot_;
  AxisKind axes_;
  std::size_t tool_;
  Pose X_WB_;
  ForwardKinematics kinematics_;
  AxisVector q_, x_, lower_, upper_;
  Vec3 p_WT_ = Vec3::Zero();
  Eigen::Matrix3d R_WT_ = Eigen::Matrix3d::Identity();
  Jacobian jacobian_;
  Eigen::Matrix<double, 6, 6> inverse_square_ = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace vicinity
