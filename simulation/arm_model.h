// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A robot as MuJoCo reads it: links with mass, joints, and capsules for contacts.
#pragma once

#include <string>
#include <vector>

#include "simulation/voxel_boxes.h"
#include "vicinity/robot/robot_model.h"

namespace vicinity {

/// Capsules that fill a link's geometries from within: each geometry's bounding box, in the link's
/// axes, filled by parallel capsules along its longest side, as thick as its shortest. A cylinder
/// along an axis of the link is met exactly, but for the edges of its ends; a box but for its
/// edges.
std::vector<Capsule> capsules_of(const Link& link);

/// What the model text is made for.
struct ArmModelOptions {
  Pose X_WB = Pose::Identity();
  double step_s = 0.002;
  int contact_boxes = 20;  ///< boxes of the workplace that can be there at once
  double armature = 0.05;  ///< what rotors add to each joint's inertia [kg·m²]; a few % of a link's
};

/// Masses, joints, contact shapes as MJCF text. Bodies are named as links, joints as joints, boxes
/// box_0, box_1, ...
/// Errors: throws Error for a link that moves and has no inertia, and a robot that cannot move.
std::string arm_as_mjcf(const RobotModel& robot, const ArmModelOptions& options);

}  // namespace vicinity
