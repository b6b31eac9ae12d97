// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/geometry/vec3.h"

namespace vicinity {

Pose pose_from_rpy(const Vec3& xyz, const Vec3& rpy) {
  Pose pose = Pose::Identity();
  pose.translate(xyz);
  pose.rotate(Eigen::AngleAxisd(rpy.z(), Vec3::UnitZ()));
  pose.rotate(Eigen::AngleAxisd(rpy.y(), Vec3::UnitY()));
  pose.rotate(Eigen::AngleAxisd(rpy.x(), Vec3::UnitX()));
  return pose;
}

Pose pose_from_quaternion(const Vec3& xyz, const Eigen::Vector4d& xyzw) {
  Pose pose = Pose::Identity();
  pose.translate(xyz);
  pose.rotate(Eigen::Quaterniond(xyzw.w(), xyzw.x(), xyzw.y(), xyzw.z()).normalized());
  return pose;
}

}  // namespace vicinity
