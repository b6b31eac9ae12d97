// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "live/hand.h"

#include <algorithm>
#include <cmath>

namespace vicinity::viewer {
namespace {

// Turning counts as moving a point this far from the tool's origin [m].
constexpr double turning_lever = 0.2;
// Damping of the least squares [m]: where the tool can hardly be moved some way, joints do not
// race.
constexpr double least_squares_damping = 0.03;
// How fast a hand that nobody pulls stops [s].
constexpr double stopping_s = 0.06;

// The turn from one orientation to another, in W [rad].
Vec3 turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) noexcept {
  Eigen::Quaterniond turn = to * from.conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  const double sine = turn.vec().norm();
  if (sine < 1e-9) return 2 * turn.vec();
  return 2 * std::atan2(sine, turn.w()) / sine * turn.vec();
}

Vec3 at_most(const Vec3& vector, double length) noexcept {
  const double norm = vector.norm();
  return norm > length ? Vec3(length / norm * vector) : vector;
}

// A mass on a critically damped spring that feels a force against its motion: one period. The drag
// brakes, and never turns the motion round, however coarse the period is.
Vec3 sprung(const Vec3& velocity, const Vec3& stretch, double stiffness, double mass,
            const Vec3& drag, double period_s) noexcept {
  const double damping = 2 * std::sqrt(stiffness * mass);
  const double speed = velocity.norm();
  const double against = speed > 0 ? std::max(0.0, -drag.dot(velocity)) / (speed * speed) : 0;
  return (velocity + period_s / mass * stiffness * stretch) /
         (1 + period_s / mass * (damping + against));
}

}  // namespace

Hand::Hand(const RobotModel& robot, int tool_link, const AxisVector& q, const HandOptions& options)
    : robot_(robot), tool_(static_cast<std::size_t>(tool_link)), options_(options), q_(q) {
  const Eigen::Index n = q.size();
  int joints = 0;
  for (std::size_t link = tool_; link > 0;
       link = static_cast<std::size_t>(robot.joints[link - 1].parent)) {
    joints += robot.joints[link - 1].coordinate >= 0 ? 1 : 0;
  }
  can_orient_ = joints >= 6;
  qd_ = wanted_ = lower_ = upper_ = fastest_ = AxisVector::Zero(n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const Joint& joint =
        robot.joints[static_cast<std::size_t>(robot.coordinates[static_cast<std::size_t>(c)])];
    lower_[c] = joint.limits.lower;
    upper_[c] = joint.limits.upper;
    fastest_[c] = std::isfinite(joint.limits.velocity) && joint.limits.velocity > 0
                      ? joint.limits.velocity
                  : joint.type == JointType::prismatic ? options.sliding_joint_speed
                                                       : options.turning_joint_speed;
  }
}

void Hand::move(const Drive& drive, const ForwardKinematics& kinematics, const AxisVector& torque,
                double period_s) noexcept {
  const bool begins = drive.mode != mode_;
  if (begins && drive.mode == DriveMode::tool) {
    kept_ = Eigen::Quaterniond(kinematics.R_WL(tool_));
    v_ = kinematics.v_WLo(tool_);
    w_ = kinematics.w_WL(tool_);
  }
  mode_ = drive.mode;
  pulled_to_ = kinematics.p_WL(tool_);
  felt_ = lag_ = 0;
  switch (drive.mode) {
    case DriveMode::hold:
      return come_to_rest(period_s);
    case DriveMode::tool:
      return move_tool(drive, kinematics, torque, period_s);
    case DriveMode::joints:
      return move_joints(drive.q, torque, period_s);
    case DriveMode::follow:
      return follow(drive.q, period_s);
  }
}

void Hand::move_tool(const Drive& drive, const ForwardKinematics& kinematics,
                     const AxisVector& torque, double period_s) noexcept {
  const auto J = jacobian(kinematics);
  // J' (J J' + damping² 1)^-1 with turns as ways of a lever. An arm of few joints turns its tool as
  // it must, unless it is told otherwise.
  const double lever = can_orient_ || drive.orientation_counts ? turning_lever : 0;
  Eigen::Matrix<double, 6, 1> weight;
  weight << 1, 1, 1, lever, lever, lever;
  const Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, axis_capacity> weighed =
      weight.asDiagonal() * J;
  Eigen::Matrix<double, 6, 6> square = weighed.lazyProduct(weighed.transpose());
  square.diagonal().array() += least_squares_damping * least_squares_damping;
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(square);

  // The same map's transpose brings the drag's torques to the hand.
  const Eigen::Matrix<double, 6, 1> projected = weighed.lazyProduct(torque);
  const Eigen::Matrix<double, 6, 1> solved = solver.solve(projected);
  const Vec3 force = solved.head<3>(), moment = lever * solved.tail<3>();

  const Vec3 stretch = at_most(drive.p_WT - kinematics.p_WL(tool_), options_.longest_pull);
  const Vec3 turn = turn_between(Eigen::Quaterniond(kinematics.R_WL(tool_)),
                                 drive.orientation_counts ? drive.R_WT : kept_);
  pulled_to_ = drive.p_WT;
  lag_ = (drive.p_WT - kinematics.p_WL(tool_)).norm();
  const double speed = v_.norm();
  felt_ = speed > 0 ? std::max(0.0, -force.dot(v_)) / speed : 0;

  v_ = at_most(sprung(v_, stretch, options_.stiffness, options_.mass, force, period_s),
               options_.fastest_tool);
  w_ = sprung(w_, turn, options_.turning_stiffness, options_.turning_inertia, moment, period_s);

  Eigen::Matrix<double, 6, 1> twist;
  twist << v_, lever * w_;
  const Eigen::Matrix<double, 6, 1> carried = solver.solve(twist);
  wanted_ = weighed.transpose().lazyProduct(carried);
  step_to(wanted_, period_s);
  // Where the arm cannot follow, at a limit or stretched out, the hand does not run on.
  const Eigen::Matrix<double, 6, 1> went = J.lazyProduct(qd_);
  v_ = went.head<3>();
  w_ = went.tail<3>();
}

void Hand::move_joints(const AxisVector& target, const AxisVector& torque,
                       double period_s) noexcept {
  const double inertia = options_.joint_inertia;
  const double stiffness = inertia * options_.joint_frequency * options_.joint_frequency;
  const double damping = 2 * inertia * options_.joint_frequency;
  double square = 0;
  for (Eigen::Index c = 0; c < q_.size(); ++c) {
    const double stretch = std::clamp(target[c], lower_[c], upper_[c]) - q_[c];
    const double against = qd_[c] != 0 ? std::max(0.0, -torque[c] / qd_[c]) : 0;
    wanted_[c] = (qd_[c] + period_s / inertia * stiffness * stretch) /
                 (1 + period_s / inertia * (damping + against));
    square += stretch * stretch;
  }
  lag_ = std::sqrt(square);
  step_to(wanted_, period_s);
}

// Exactly there, where the joints' limits and speeds allow it.
void Hand::follow(const AxisVector& target, double period_s) noexcept {
  wanted_ = target.cwiseMax(lower_).cwiseMin(upper_) - q_;
  lag_ = wanted_.norm();
  wanted_ /= period_s;
  step_to(wanted_, period_s);
}

void Hand::come_to_rest(double period_s) noexcept {
  wanted_ = qd_ / (1 + period_s / stopping_s);
  if (wanted_.cwiseAbs().maxCoeff() < 1e-5) wanted_.setZero();
  step_to(wanted_, period_s);
}

// All joints are slowed alike, so that the tool keeps its direction.
void Hand::step_to(const AxisVector& wanted, double period_s) noexcept {
  double share = 1;
  for (Eigen::Index c = 0; c < q_.size(); ++c) {
    const double speed = std::abs(wanted[c]);
    if (speed * share > fastest_[c]) share = fastest_[c] / speed;
  }
  for (Eigen::Index c = 0; c < q_.size(); ++c) {
    double next = std::clamp(q_[c] + share * wanted[c] * period_s, lower_[c], upper_[c]);
    if (!std::isfinite(next)) next = q_[c];  // what is wanted is so far that no number says it
    qd_[c] = (next - q_[c]) / period_s;
    q_[c] = next;
  }
}

Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, axis_capacity> Hand::jacobian(
    const ForwardKinematics& kinematics) const noexcept {
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, axis_capacity> J =
      Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, axis_capacity>::Zero(6, q_.size());
  const Vec3& p_WT = kinematics.p_WL(tool_);
  for (std::size_t link = tool_; link > 0;) {
    const Joint& joint = robot_.joints[link - 1];
    if (joint.coordinate >= 0) {
      const Vec3 axis_W = joint.multiplier * (kinematics.R_WL(link) * joint.axis_J);
      if (joint.type == JointType::prismatic) {
        J.col(joint.coordinate).head<3>() += axis_W;
      } else {
        J.col(joint.coordinate).head<3>() += axis_W.cross(p_WT - kinematics.p_WL(link));
        J.col(joint.coordinate).tail<3>() += axis_W;
      }
    }
    link = static_cast<std::size_t>(joint.parent);
  }
  return J;
}

}  // namespace vicinity::viewer
