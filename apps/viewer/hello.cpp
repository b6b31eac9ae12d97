// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "hello.h"

#include <algorithm>
#include <cmath>

namespace vicinity::viewer {
namespace {

using Json = nlohmann::ordered_json;

Json pose_json(const Pose& X) {
  const Vec3& p = X.translation();
  const Eigen::Quaterniond turn(X.linear());
  return {p.x(), p.y(), p.z(), turn.x(), turn.y(), turn.z(), turn.w()};
}

const char* word(JointType type) {
  switch (type) {
    case JointType::fixed:
      return "fixed";
    case JointType::revolute:
      return "revolute";
    case JointType::continuous:
      return "continuous";
    case JointType::prismatic:
      return "prismatic";
  }
  return "fixed";
}

Json stated(double limit) { return std::isfinite(limit) ? Json(limit) : Json(); }

}  // namespace

Json field_json(const Workplace& workplace) {
  const ViscosityField& field = workplace.field;
  const Workspace& w = field.workspace();
  int ranks = 0;
  Json objects = Json::array();
  for (const FieldObject& object : field.objects()) {
    ranks = std::max(ranks, object.q);
    objects.push_back({{"name", object.name},
                       {"shape", to_string(object.layers)},
                       {"m", object.m},
                       {"q", object.q},
                       {"coding", object.coding.mu},
                       {"skin", object.coding.skin},
                       {"bound_mm", object.bound_mm},
                       {"closed", object.closed},
                       {"triangles", object.triangles},
                       {"boundary", object.boundary},
                       {"inner", object.inner},
                       {"ranks", object.ranks}});
  }
  const auto viscosities = field.viscosities();
  const std::vector<double> viscosity(viscosities.begin(), viscosities.end());
  Json kinds = Json::array(), rank = Json::array(), object = Json::array();
  for (const VoxelRecord& record : field.records()) {
    kinds.push_back(static_cast<int>(record.kind));
    rank.push_back(record.rank);
    object.push_back(record.object);
  }
  const VoxelCounts& counts = field.voxel_counts();
  return {
      {"name", workplace.name},
      {"bytes", field.image().size()},
      {"voxel_size", w.voxel_size},
      {"origin", {w.origin.x(), w.origin.y(), w.origin.z()}},
      {"dims", {w.dims.i, w.dims.j, w.dims.k}},
      {"keeps_distance", field.keeps_distance()},
      {"ranks", ranks},
      {"voxels",
       {{"boundary", counts.boundary}, {"inner", counts.inner}, {"neighbour", counts.neighbour}}},
      {"objects", objects},
      {"records", {{"kind", kinds}, {"rank", rank}, {"object", object}, {"viscosity", viscosity}}}};
}

Json robot_json(const ShownRobot& shown) {
  const RobotModel& robot = shown.robot;
  Json links = Json::array(), joints = Json::array(), coordinates = Json::array();
  for (std::size_t n = 0; n < robot.links.size(); ++n) {
    links.push_back(
        {{"name", robot.links[n].name}, {"mesh", static_cast<bool>(shown.has_mesh[n])}});
  }
  for (std::size_t n = 0; n < robot.joints.size(); ++n) {
    const Joint& joint = robot.joints[n];
    joints.push_back({{"name", joint.name},
                      {"type", word(joint.type)},
                      {"parent", joint.parent},
                      {"link", n + 1},
                      {"coordinate", joint.coordinate},
                      {"multiplier", joint.multiplier},
                      {"offset", joint.offset},
                      {"pose", pose_json(joint.X_PJ)},
                      {"axis", {joint.axis_J.x(), joint.axis_J.y(), joint.axis_J.z()}}});
  }
  for (const int n : robot.coordinates) {
    const Joint& joint = robot.joints[static_cast<std::size_t>(n)];
    coordinates.push_back({{"name", joint.name},
                           {"type", word(joint.type)},
                           {"lower", stated(joint.limits.lower)},
                           {"upper", stated(joint.limits.upper)},
                           {"velocity", stated(joint.limits.velocity)},
                           {"effort", stated(joint.limits.effort)}});
  }
  return {{"name", robot.name},
          {"tool_link", shown.tool_link},
          {"base", pose_json(shown.X_WB)},
          {"links", links},
          {"joints", joints},
          {"coordinates", coordinates},
          {"probe", shown.probe},
          {"points", shown.points},
          {"points_shown", shown.points_shown},
          {"remarks", shown.remarks}};
}

Json scene_json(const SceneDocument& document) {
  if (document.scene.is_null()) return nullptr;
  return {{"name", document.name}, {"scene", document.scene}};
}

}  // namespace vicinity::viewer
