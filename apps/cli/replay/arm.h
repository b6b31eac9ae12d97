// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The arm that is moved: robot, body points and how it feels, from the words of the command
/// line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/teleop/tick.h"

namespace vicinity::cli {

/// Empty: not said. What is said wins over the scene's `robot` block.
struct ArmOptions {
  std::filesystem::path scene;                  ///< takes its `robot` block
  std::filesystem::path robot;                  ///< URDF
  std::vector<std::filesystem::path> packages;  ///< folders for package:// addresses
  std::string base;                             ///< "x,y,z,r,p,y" [m, rad]
  std::string exclude;                          ///< "link,link": they feel nothing
  std::string tool;                             ///< link
  std::optional<double> points_per_m2;
  std::optional<std::size_t> points;  ///< in all, in place of a density
  std::string memory = "none", direction = "all", traversal = "swept";
  std::string device;           ///< a known name, or a .yaml file
  std::string mode = "strict";  ///< of the limiter: strict, device
  std::string master;           ///< "G,A,L,lambda" of eq. 8-10
  std::optional<double> rate;   ///< [Hz]; else that of the device, else 1000
};

struct Arm {
  RobotModel robot;
  BodyPoints points;
  Pose X_WB = Pose::Identity();
  double rate = 1000;  ///< ticks per second [Hz]
  TeleoperationOptions teleoperation;
  std::string limiter;                    ///< in words
  std::vector<std::string> remarks = {};  ///< oddities, one sentence each
};

/// The files that the options name: robot, scene and device.
std::vector<std::filesystem::path> files_of(const ArmOptions& options);

/// Errors: throws Error for a file that cannot be used, for words that fit nothing, and for a
/// device that is for another arm.
Arm read_arm(const ArmOptions& options);

/// How an arm feels and how often it ticks, for whoever has a robot of his own: without robot,
/// points and place. Errors: as read_arm().
Arm bodiless_arm(const ArmOptions& options);

/// The demo's arm in the hot cell, feeling as the options say. Errors: as read_arm().
Arm hot_cell_arm(const ArmOptions& options);

/// Name of a coordinate's joint.
const std::string& joint_name(const RobotModel& robot, std::size_t coordinate);

}  // namespace vicinity::cli
