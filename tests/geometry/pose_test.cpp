// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>

#include "vicinity/geometry/vec3.h"

namespace vicinity {
namespace {

TEST(Pose, RollPitchYawTurnAboutFixedAxesInThatOrder) {
  const Vec3 rpy(0.3, -0.7, 1.9);
  // By another route: one plain rotation matrix per fixed axis, the first applied first.
  const auto about = [](int axis, double angle) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    rotation(a, a) = rotation(b, b) = std::cos(angle);
    rotation(b, a) = std::sin(angle);
    rotation(a, b) = -std::sin(angle);
    return rotation;
  };
  const Vec3 xyz(1, 2, 3), p(0.4, 0.5, -0.6);
  const Vec3 expected = about(2, rpy.z()) * (about(1, rpy.y()) * (about(0, rpy.x()) * p)) + xyz;
  EXPECT_LT((pose_from_rpy(xyz, rpy) * p - expected).norm(), 1e-15);
}

TEST(Pose, AQuaternionOfAnyLengthIsTheSameTurn) {
  const double half = 0.5 * 1.1;
  const Vec3 p(0.4, 0.5, -0.6);
  const Vec3 expected = pose_from_rpy({1, 2, 3}, {0, 0, 1.1}) * p;
  for (const double length : {1.0, 0.01, 250.0}) {
    const Eigen::Vector4d xyzw = length * Eigen::Vector4d(0, 0, std::sin(half), std::cos(half));
    EXPECT_LT((pose_from_quaternion({1, 2, 3}, xyzw) * p - expected).norm(), 1e-15) << length;
  }
}

}  // namespace
}  // namespace vicinity
