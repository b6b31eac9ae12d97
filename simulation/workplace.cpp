// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/workplace.h"

#include <utility>

#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

// No link goes farther from the base than all offsets end to end, and its own size.
double reach_of(const RobotModel& robot) {
  double reach = 0, largest = 0;
  for (const Joint& joint : robot.joints) {
    reach += joint.X_PJ.translation().norm();
    if (joint.type == JointType::prismatic) {
      reach += std::min(2.0, std::max(std::abs(joint.limits.lower), std::abs(joint.limits.upper)));
    }
  }
  for (const Link& link : robot.links) {
    for (const LinkGeometry& geometry : link.geometries) {
      const Box box = geometry.mesh.bounds();
      if (box.isEmpty()) continue;
      largest = std::max({largest, box.min().norm(), box.max().norm()});
    }
  }
  return reach + largest;
}

}  // namespace

Workplace build_workplace(const Scene& scene, RobotModel robot, const Pose& X_WB, int tool_link,
                          const std::vector<std::string>& exclude, std::size_t points,
                          double step_s) {
  Workplace place;
  place.ranked = build_field(scene).field;
  Scene continuous = scene;
  for (SceneObject& object : continuous.objects) object.layers = LayerShape::distance;
  place.distance = build_field(continuous).field;
  place.distance_clearance = std::make_shared<const ClearanceMap>(place.distance);
  place.robot = std::move(robot);
  place.X_WB = X_WB;
  place.tool_link = tool_link;
  place.step_s = step_s;
  BodyPointOptions sampling;
  sampling.total = points;
  sampling.exclude = exclude;
  // What stands still feels nothing.
  for (std::size_t link = 0; link < place.robot.links.size(); ++link) {
    bool moves = false;
    for (std::size_t at = link; at > 0;
         at = static_cast<std::size_t>(place.robot.joints[at - 1].parent)) {
      moves = moves || place.robot.joints[at - 1].type != JointType::fixed;
    }
    if (!moves) sampling.exclude.push_back(place.robot.links[link].name);
  }
  place.points = sample_body_points(place.robot, sampling);
  if (place.points.count() == 0) {
    throw Error({.where = "robot '" + place.robot.name + "'",
                 .what = "no link that moves has a surface, so that nothing of the arm can feel"});
  }
  const Vec3 reach = Vec3::Constant(reach_of(place.robot));
  place.boxes = std::make_shared<const VoxelBoxes>(
      place.ranked, Box(X_WB.translation() - reach, X_WB.translation() + reach));
  return place;
}

Device study_device() {
  Device device = known_device("omega.6");
  device.name = "study handle";
  device.mass = {0.3};
  device.physical_damping = {3};
  device.encoder_step = {1e-5};
  device.dry_friction = {0.1};
  device.sample_period = 0.001;
  return device;
}

}  // namespace vicinity
