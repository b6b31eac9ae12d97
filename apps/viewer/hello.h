// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// HELLO: all that a page must know before anything moves.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/robot/robot_model.h"
#include "workplace.h"

namespace vicinity::viewer {

nlohmann::ordered_json field_json(const Workplace& workplace);

/// What there is to say about the arm.
struct ShownRobot {
  const RobotModel& robot;
  Pose X_WB = Pose::Identity();
  int tool_link = 0;
  bool probe = false;
  std::size_t points = 0, points_shown = 0;
  const std::vector<std::string>& remarks;
  const std::vector<bool>& has_mesh;  ///< by link
};
nlohmann::ordered_json robot_json(const ShownRobot& shown);

/// SCENE; null where there is none.
nlohmann::ordered_json scene_json(const SceneDocument& document);

}  // namespace vicinity::viewer
