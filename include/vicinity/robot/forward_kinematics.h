// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Joint angles in, poses and velocities of all links out; and back: wrenches on links in, joint
/// torques out.
#pragma once

#include <cstddef>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/robot/robot_model.h"

namespace vicinity {

/// Force and moment on a link, both in W; the moment is about the link's origin Lo.
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< shape (3,) [N]
  Vec3 moment = Vec3::Zero();  ///< shape (3,) [N·m]
};

/// Kinematics of one robot in one state. Memory is taken by the constructor; nothing after it
/// allocates, throws or locks. Links and joints are numbered as in RobotModel.
class ForwardKinematics {
 public:
  /// At q = 0, at rest, base at the origin of W. Errors: as check(robot).
  explicit ForwardKinematics(const RobotModel& robot);

  std::size_t link_count() const noexcept { return p_WL_.size(); }
  std::size_t coordinate_count() const noexcept { return coordinate_count_; }

  /// Moves all links, in one pass from the base to the leaves. The base stands still in W.
  ///
  /// @param q     joint coordinates, shape (coordinate_count(),)  [rad or m]
  /// @param qd    their velocities, same shape                    [rad/s or m/s]
  /// @param X_WB  pose of the base, links[0]
  /// Errors: none; what is not finite comes out as it went in.
  /// Real-time: O(links); about 0.05 microseconds for each moving joint.
  void update(const double* q, const double* qd, const Pose& X_WB) noexcept;

  /// Pose of a link, its rotation R_WL and its origin p_WL [m] alone.
  Pose X_WL(std::size_t link) const noexcept;
  const Eigen::Matrix3d& R_WL(std::size_t link) const noexcept { return R_WL_[link]; }
  const Vec3& p_WL(std::size_t link) const noexcept { return p_WL_[link]; }

  /// Velocity of a link: angular [rad/s], and linear of its origin [m/s]; shape (3,), in W. A point
  /// R fixed to the link moves with v_WLo + w_WL x (p_WR - p_WL).
  const Vec3& w_WL(std::size_t link) const noexcept { return w_WL_[link]; }
  const Vec3& v_WLo(std::size_t link) const noexcept { return v_WLo_[link]; }

  /// Joint torques that do the same work as the wrenches: exactly the transpose of the velocity
  /// map, so that sum(force . v_WLo + moment . w_WL) = tau . qd for every qd. One pass from the
  /// leaves to the base; each link's wrench is carried down once.
  ///
  /// @param wrenches  one for each link, shape (link_count(),)
  /// @param tau       out, shape (coordinate_count(),)  [N·m or N]
  /// @return          the sum of all wrenches, about the origin of the base: what its mount bears
  Wrench joint_torques(const Wrench* wrenches, double* tau) noexcept;

 private:
  enum class Motion : unsigned char { none, turn, slide };

  std::size_t coordinate_count_ = 0;
  // One entry for each joint; joint i moves link i + 1.
  std::vector<Motion> motion_;
  std::vector<int> parent_, coordinate_;
  std::vector<double> multiplier_, offset_;
  // Rodrigues' formula with all but the angle done: R_PL = R_PJ + sin R_PJ K + (1 - cos) R_PJ K²,
  // where K x = axis_J x x.
  std::vector<Eigen::Matrix3d> R_PJ_, R_PJ_K_, R_PJ_KK_;
  std::vector<Vec3> p_PJ_, axis_P_, axis_W_;
  // One entry for each link.
  std::vector<Eigen::Matrix3d> R_WL_;
  std::vector<Vec3> p_WL_, w_WL_, v_WLo_;
  std::vector<Wrench> carried_;
};

}  // namespace vicinity
