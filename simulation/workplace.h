// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What the arm works on: everything about a scene and a robot that trials share.
#pragma once

#include <memory>

#include "simulation/voxel_boxes.h"
#include "vicinity/drag/clearance_map.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/teleop/device.h"
#include "vicinity/viscosity/field.h"
#include "vicinity/viscosity/scene.h"

namespace vicinity {

struct Workplace {
  RobotModel robot;
  Pose X_WB = Pose::Identity();
  int tool_link = 0;
  BodyPoints points;
  ViscosityField ranked;    ///< layers as the scene has them
  ViscosityField distance;  ///< the same objects and layers in `distance` mode
  std::shared_ptr<const ClearanceMap> distance_clearance;
  std::shared_ptr<const VoxelBoxes> boxes;
  double step_s = 0.002;  ///< of the physics, and period of the slave's controller [s]
};

/// Builds both fields of a scene, and its boxes as far as the arm can reach.
/// @param points  how many body points there are in all
/// Errors: throws Error for a scene or an arm that cannot be used.
Workplace build_workplace(const Scene& scene, RobotModel robot, const Pose& X_WB, int tool_link,
                          const std::vector<std::string>& exclude, std::size_t points,
                          double step_s);

/// The handle in the operator's hand, as the study has it: a three-axis device of the better kind,
/// as the omega.6 (ceiling, force and resolution). Its own mass, damping and friction are chosen:
/// makers publish none, and `strict` rests on the damping.
Device study_device();

}  // namespace vicinity
