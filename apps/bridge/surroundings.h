// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What of the field is near the arm, and what it feels: to be looked at in RViz.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "arm_loop.h"
#include "ros2/shown_messages.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::bridge {

/// For one thread. Not real-time.
class Surroundings {
 public:
  static constexpr double near_m = 0.1;               ///< from the arm's surface
  static constexpr std::size_t most_points = 20'000;  ///< in a cloud: about 300 kB

  /// Both outlive it. @param world  the frame that W is called
  Surroundings(const RobotModel& robot, const BodyPoints& points, int tool_link, std::string world);

  /// Another field from now on.
  void look_at(ViscosityField field) { field_ = std::move(field); }

  /// Centres of ranked voxels no farther than near_m from the balls that hold the arm's points,
  /// as x, y, z and rank, float32 each; of more than most_points every second, third, ... is kept.
  ros2::PointCloud2 layers(const Answer& answer);

  /// The force at the tool as an arrow, 0.1 m for each newton, and why in words beside it.
  ros2::MarkerArray markers(const Answer& answer);

 private:
  const RobotModel& robot_;
  const BodyPoints& points_;
  std::optional<ViscosityField> field_;
  std::size_t tool_link_;
  std::string world_;
  ForwardKinematics kinematics_;
  AxisVector at_rest_;
};

}  // namespace vicinity::bridge
