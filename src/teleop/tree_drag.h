// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// From the drag of each link to the drag of the joints, carried down the tree once.
#pragma once

#include <vector>

#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/teleop/axes.h"

namespace vicinity {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// D = sum over links of J_L' A_L J_L, by the composite method that mass matrices are made with:
/// drags about one point of W add up, so that every link hands its own and its children's to its
/// parent, and D_ij is what joint j's motion costs joint i through the links beyond both.
class TreeDrag {
 public:
  explicit TreeDrag(const RobotModel& robot);

  /// @param link_drag  A_L, wrench = -A_L (v_WLo, w_WL) in W about each link's origin
  /// @param drag       out: D, shape (coordinates, coordinates), symmetric
  /// Real-time: O(links + joints * depth), no allocation.
  void carry(const ForwardKinematics& kinematics, const std::vector<Matrix6>& link_drag,
             AxisMatrix& drag) noexcept;

  /// The drag of all links together, in W, about a point of W.
  static Wrench total(const ForwardKinematics& kinematics, const std::vector<Matrix6>& link_drag,
                      const Vec3& p_W) noexcept;

 private:
  std::vector<Joint> joints_;
  std::vector<Matrix6> carried_;      // by link, about the origin of W
  std::vector<Vector6> joint_twist_;  // by joint: motion of its link per unit of its coordinate
};

}  // namespace vicinity
