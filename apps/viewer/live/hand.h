// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The hand between the pointer and the arm: it has mass, is pulled by the pointer through a
/// spring, and feels the drag. So whoever moves a mouse feels a part come near: the tool stays
/// behind.
///
///   pointer --spring, damper--> hand (mass) --velocity--> arm
///                                  ^------- drag -----------+
///
/// Its velocity goes to the joints by damped least squares, and the drag's torques come back
/// through the transpose of the same map: what the hand loses is what the drag takes.
#pragma once

#include "live/drive.h"
#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/robot/robot_model.h"

namespace vicinity::viewer {

/// A grip of medium strength. Critically damped: without drag the tool follows without overshoot,
/// 2 damping / stiffness behind: 8 cm at 0.5 m/s. A drag of 25 N·s/m makes that 12 cm.
struct HandOptions {
  double stiffness = 300;         ///< of the spring [N/m]
  double mass = 0.5;              ///< [kg]
  double turning_stiffness = 6;   ///< [N·m/rad]
  double turning_inertia = 0.01;  ///< [kg·m²]
  double joint_frequency = 12;    ///< of a joint's own spring and mass [rad/s]
  double joint_inertia = 0.5;     ///< [kg·m² or kg]
  double longest_pull = 0.25;     ///< the spring pulls no farther [m]
  double fastest_tool = 1.0;      ///< [m/s]
  double turning_joint_speed = 1.5, sliding_joint_speed = 0.5;  ///< where the robot states none
};

class Hand {
 public:
  /// Starts at rest at q. @param tool_link  as in TeleoperationOptions, not below zero
  Hand(const RobotModel& robot, int tool_link, const AxisVector& q,
       const HandOptions& options = {});

  /// One period: where the joints go.
  /// @param drive       what is asked; numbers are finite and sizes right
  /// @param kinematics  of the q and qd that the last period ended with
  /// @param torque      drag on the joints in the last tick, shape (coordinates,) [N·m or N]
  /// @param period_s    > 0
  /// Real-time: no allocation; about 2 microseconds for seven joints.
  void move(const Drive& drive, const ForwardKinematics& kinematics, const AxisVector& torque,
            double period_s) noexcept;

  const AxisVector& q() const noexcept { return q_; }    ///< within the joints' limits
  const AxisVector& qd() const noexcept { return qd_; }  ///< exactly (q - last q) / period
  double felt() const noexcept { return felt_; }         ///< drag against the way the hand goes [N]
  double lag() const noexcept { return lag_; }           ///< as SNAPSHOT has it [m or rad]
  const Vec3& pulled_to() const noexcept { return pulled_to_; }  ///< in W [m]

 private:
  void move_tool(const Drive& drive, const ForwardKinematics& kinematics, const AxisVector& torque,
                 double period_s) noexcept;
  void move_joints(const AxisVector& target, const AxisVector& torque, double period_s) noexcept;
  void follow(const AxisVector& target, double period_s) noexcept;
  void come_to_rest(double period_s) noexcept;
  void step_to(const AxisVector& wanted, double period_s) noexcept;
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, axis_capacity> jacobian(
      const ForwardKinematics& kinematics) const noexcept;

  RobotModel robot_;
  std::size_t tool_;
  bool can_orient_ = false;  // enough joints lead to the tool to place and to turn it at will
  HandOptions options_;
  AxisVector q_, qd_, wanted_, lower_, upper_, fastest_;
  DriveMode mode_ = DriveMode::hold;
  Vec3 v_ = Vec3::Zero(), w_ = Vec3::Zero();  // of the hand, in W
  Eigen::Quaterniond kept_ = Eigen::Quaterniond::Identity();
  Vec3 pulled_to_ = Vec3::Zero();
  double felt_ = 0, lag_ = 0;
};

}  // namespace vicinity::viewer
