// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "tree_drag.h"

namespace vicinity {

TreeDrag::TreeDrag(const RobotModel& robot)
    : joints_(robot.joints),
      carried_(robot.links.size(), Matrix6::Zero()),
      joint_twist_(robot.joints.size(), Vector6::Zero()) {}

void TreeDrag::carry(const ForwardKinematics& kinematics, const std::vector<Matrix6>& link_drag,
                     AxisMatrix& drag) noexcept {
  drag.setZero();
  // Twists about the origin of W: v_WLo = v_0 + omega x p, so that a link's drag moves there as X'
  // A X.
  for (std::size_t link = 0; link < carried_.size(); ++link) {
    if (link_drag[link].isZero(0)) {
      carried_[link].setZero();
      continue;
    }
    const Vec3& p = kinematics.p_WL(link);
    Matrix6 X = Matrix6::Identity();
    X.topRightCorner<3, 3>() << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
    carried_[link].noalias() = X.transpose() * link_drag[link] * X;
  }
  for (std::size_t i = joints_.size(); i-- > 0;) {
    const Joint& joint = joints_[i];
    const Matrix6& beyond = carried_[i + 1];
    carried_[static_cast<std::size_t>(joint.parent)] += beyond;
    if (joint.coordinate < 0) continue;
    const Vec3 axis_W = kinematics.R_WL(i + 1) * joint.axis_J;
    if (joint.type == JointType::prismatic) {
      joint_twist_[i] << joint.multiplier * axis_W, Vec3::Zero();
    } else {
      joint_twist_[i] << joint.multiplier * kinematics.p_WL(i + 1).cross(axis_W),
          joint.multiplier * axis_W;
    }
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].coordinate < 0 || carried_[i + 1].isZero(0)) continue;
    const Vector6 cost = carried_[i + 1] * joint_twist_[i];
    const int ci = joints_[i].coordinate;
    drag(ci, ci) += joint_twist_[i].dot(cost);
    for (int link = joints_[i].parent; link > 0;) {
      const auto j = static_cast<std::size_t>(link - 1);
      if (const int cj = joints_[j].coordinate; cj >= 0) {
        const double shared = joint_twist_[j].dot(cost);
        drag(ci, cj) += shared;
        drag(cj, ci) += shared;
      }
      link = joints_[j].parent;
    }
  }
}

Wrench TreeDrag::total(const ForwardKinematics& kinematics, const std::vector<Matrix6>& link_drag,
                       const Vec3& p_W) noexcept {
  Wrench total;
  for (std::size_t link = 0; link < link_drag.size(); ++link) {
    if (link_drag[link].isZero(0)) continue;
    Vector6 twist;
    twist << kinematics.v_WLo(link), kinematics.w_WL(link);
    const Vector6 wrench = -link_drag[link] * twist;
    const Vec3 force = wrench.head<3>();
    total.force += force;
    total.moment += wrench.tail<3>() + (kinematics.p_WL(link) - p_W).cross(force);
  }
  return total;
}

}  // namespace vicinity
