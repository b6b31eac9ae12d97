// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/robot/forward_kinematics.h"

#include <algorithm>
#include <cmath>

namespace vicinity {
ForwardKinematics::ForwardKinematics(const RobotModel& robot)
    : coordinate_count_(robot.coordinates.size()) {
  check(robot);
  for (const Joint& joint : robot.joints) {
    const bool moves = joint.type != JointType::fixed;
    motion_.push_back(!moves                               ? Motion::none
                      : joint.type == JointType::prismatic ? Motion::slide
                                                           : Motion::turn);
    parent_.push_back(joint.parent);
    coordinate_.push_back(moves ? joint.coordinate : -1);
    multiplier_.push_back(joint.multiplier);
    offset_.push_back(joint.offset);
    Eigen::Matrix3d K;
    const Vec3& axis = joint.axis_J;
    K << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
    R_PJ_.push_back(joint.X_PJ.linear());
    R_PJ_K_.push_back(joint.X_PJ.linear() * K);
    R_PJ_KK_.push_back(joint.X_PJ.linear() * K * K);
    p_PJ_.push_back(joint.X_PJ.translation());
    axis_P_.push_back(joint.X_PJ.linear() * axis);
  }
  axis_W_.assign(robot.joints.size(), Vec3::Zero());
  R_WL_.assign(robot.links.size(), Eigen::Matrix3d::Identity());
  p_WL_.assign(robot.links.size(), Vec3::Zero());
  w_WL_.assign(robot.links.size(), Vec3::Zero());
  v_WLo_.assign(robot.links.size(), Vec3::Zero());
  carried_.resize(robot.links.size());
  const std::vector<double> zero(coordinate_count_, 0.);
  update(zero.data(), zero.data(), Pose::Identity());
}

void ForwardKinematics::update(const double* q, const double* qd, const Pose& X_WB) noexcept {
  R_WL_[0] = X_WB.linear();
  p_WL_[0] = X_WB.translation();
  for (std::size_t joint = 0; joint < parent_.size(); ++joint) {
    const std::size_t link = joint + 1, parent = static_cast<std::size_t>(parent_[joint]);
    Vec3 p_PL_W = R_WL_[parent] * p_PJ_[joint];
    w_WL_[link] = w_WL_[parent];
    v_WLo_[link] = v_WLo_[parent];
    Eigen::Matrix3d R_PL = R_PJ_[joint];
    if (motion_[joint] != Motion::none) {
      const int c = coordinate_[joint];
      const double position = c < 0 ? offset_[joint] : multiplier_[joint] * q[c] + offset_[joint];
      const double velocity = c < 0 ? 0 : multiplier_[joint] * qd[c];
      axis_W_[joint].noalias() = R_WL_[parent] * axis_P_[joint];
      if (motion_[joint] == Motion::turn) {
        R_PL += std::sin(position) * R_PJ_K_[joint] + (1 - std::cos(position)) * R_PJ_KK_[joint];
        w_WL_[link] += velocity * axis_W_[joint];
      } else {
        p_PL_W += position * axis_W_[joint];
        v_WLo_[link] += velocity * axis_W_[joint];
      }
    }
    R_WL_[link].noalias() = R_WL_[parent] * R_PL;
    p_WL_[link] = p_WL_[parent] + p_PL_W;
    v_WLo_[link] += w_WL_[parent].cross(p_PL_W);
  }
}

Pose ForwardKinematics::X_WL(std::size_t link) const noexcept {
  Pose pose = Pose::Identity();
  pose.linear() = R_WL_[link];
  pose.translation() = p_WL_[link];
  return pose;
}

Wrench ForwardKinematics::joint_torques(const Wrench* wrenches, double* tau) noexcept {
  std::copy_n(wrenches, carried_.size(), carried_.begin());
  std::fill_n(tau, coordinate_count_, 0.);
  for (std::size_t joint = parent_.size(); joint-- > 0;) {
    const std::size_t link = joint + 1, parent = static_cast<std::size_t>(parent_[joint]);
    const Wrench& on_link = carried_[link];
    if (coordinate_[joint] >= 0) {
      const Vec3& works = motion_[joint] == Motion::turn ? on_link.moment : on_link.force;
      tau[coordinate_[joint]] += multiplier_[joint] * axis_W_[joint].dot(works);
    }
    carried_[parent].force += on_link.force;
    carried_[parent].moment += on_link.moment + (p_WL_[link] - p_WL_[parent]).cross(on_link.force);
  }
  return carried_[0];
}

}  // namespace vicinity
