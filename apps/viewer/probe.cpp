// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "probe.h"

#include "vicinity/mesh/primitive.h"

namespace vicinity::viewer {
namespace {

// As large as seems handy beside the layers that it moves through.
constexpr double ball_radius_vox = 3;
constexpr int ball_segments = 32;

}  // namespace

RobotModel probe_robot(const Workspace& workspace) {
  RobotModel robot;
  robot.name = "probe";
  robot.links.push_back({.name = "base"});
  const Vec3 size =
      workspace.voxel_size * Vec3(workspace.dims.i, workspace.dims.j, workspace.dims.k);
  const char* const names[] = {"x", "y", "z"};
  const char* const links[] = {"slide_x", "slide_y", "ball"};
  for (int axis = 0; axis < 3; ++axis) {
    robot.joints.push_back({.name = names[axis],
                            .type = JointType::prismatic,
                            .parent = axis,
                            .axis_J = Vec3::Unit(axis),
                            .coordinate = axis,
                            .limits = {.lower = workspace.origin[axis],
                                       .upper = workspace.origin[axis] + size[axis],
                                       .velocity = 1}});
    robot.links.push_back({.name = links[axis]});
    robot.coordinates.push_back(axis);
  }
  robot.links.back().geometries.push_back(
      {.role = LinkGeometry::Role::visual,
       .mesh = primitive::sphere(ball_radius_vox * workspace.voxel_size, ball_segments)});
  return robot;
}

BodyPoints probe_points(const RobotModel& probe) {
  BodyPointOptions options;
  options.points_per_m2 = 0;
  options.named["ball"] = {.p_LR = Vec3::Zero(), .area = 1};
  return sample_body_points(probe, options);
}

}  // namespace vicinity::viewer
