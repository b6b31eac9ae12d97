// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "robot/robots.h"

#include <cstdlib>

namespace vicinity {

std::filesystem::path robot_file(const std::string& below_robots) {
  const char* data = std::getenv("VICINITY_DATA");
  if (!data) return {};
  const std::filesystem::path file = std::filesystem::path(data) / "robots" / below_robots;
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

Vec3 random_vector(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return {x, y, z};
}

Pose random_pose(std::mt19937_64& random) {
  const Vec3 xyz = random_vector(random);
  return pose_from_rpy(xyz, 2 * random_vector(random));
}

RobotModel random_robot(std::mt19937_64& random) {
  const auto below = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  RobotModel robot;
  robot.name = "random";
  const int links = 1 + below(30);
  for (int i = 0; i < links; ++i) robot.links.push_back({"link_" + std::to_string(i), {}});
  for (int i = 0; i + 1 < links; ++i) {
    Joint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.type = static_cast<JointType>(below(4));
    joint.parent = below(i + 1);
    joint.X_PJ = random_pose(random);
    joint.axis_J = random_vector(random).normalized();
    if (joint.type != JointType::fixed) {
      const auto coordinates = static_cast<int>(robot.coordinates.size());
      if (coordinates > 0 && below(3) == 0) {
        joint.coordinate = below(coordinates);
        joint.multiplier = random_vector(random).x();
        joint.offset = random_vector(random).x();
      } else {
        joint.coordinate = coordinates;
        robot.coordinates.push_back(i);
      }
    }
    robot.joints.push_back(joint);
  }
  return robot;
}

}  // namespace vicinity
