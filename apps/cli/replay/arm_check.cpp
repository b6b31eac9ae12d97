// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/arm_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "field_summary.h"
#include "readable.h"
#include "replay/report.h"
#include "vicinity/robot/forward_kinematics.h"

namespace vicinity::cli {
namespace {

const Joint& joint_of(const Arm& arm, Eigen::Index coordinate) {
  return arm.robot.joints[static_cast<std::size_t>(
      arm.robot.coordinates[static_cast<std::size_t>(coordinate)])];
}

// Poses to look at, shape (joints, poses): those of the log, or the one nearest to zero.
Eigen::MatrixXd poses_of(const Arm& arm, const std::optional<JointLog>& log) {
  if (log) return log->q;
  Eigen::MatrixXd q(static_cast<Eigen::Index>(arm.robot.coordinates.size()), 1);
  for (Eigen::Index c = 0; c < q.rows(); ++c) {
    q(c, 0) = std::clamp(0.0, joint_of(arm, c).limits.lower, joint_of(arm, c).limits.upper);
  }
  return q;
}

bool touches(const ForwardKinematics& kinematics, const BodyPoints& points, const Box& box) {
  return std::ranges::any_of(points.links, [&](const BodyPoints::LinkRange& range) {
    const Vec3 centre =
        kinematics.X_WL(static_cast<std::size_t>(range.link)) * range.sphere.centre.cast<double>();
    return box.exteriorDistance(centre) <= range.sphere.radius;
  });
}

std::string in_words(const Box& box) {
  return fmt::format("from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m", box.min().x(),
                     box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z());
}

// For each link, the object that holds most of its points, if any does.
std::vector<std::string> links_inside(const ViscosityField& field, const Arm& arm,
                                      const ForwardKinematics& kinematics) {
  std::vector<std::string> sentences;
  for (const BodyPoints::LinkRange& range : arm.points.links) {
    const Pose X_WL = kinematics.X_WL(static_cast<std::size_t>(range.link));
    std::map<std::uint16_t, std::size_t> inside;
    for (std::uint32_t p = range.begin; p < range.end; ++p) {
      const Vec3 p_L(arm.points.x[p], arm.points.y[p], arm.points.z[p]);
      const VoxelRecord voxel = field.at(X_WL * p_L).record;
      if (voxel.kind == VoxelKind::boundary || voxel.kind == VoxelKind::inner)
        ++inside[voxel.object];
    }
    if (inside.empty()) continue;
    const auto most = std::ranges::max_element(
        inside, [](const auto& a, const auto& b) { return a.second < b.second; });
    const std::string& link = arm.robot.links[static_cast<std::size_t>(range.link)].name;
    sentences.push_back(fmt::format(
        "at the start {} of {} points of {} are in or inside {}{}", most->second,
        range.end - range.begin, link, field.objects()[most->first].name,
        range.link == 0 ? fmt::format("; where it is mounted there, --exclude {}", link) : ""));
  }
  return sentences;
}

const char* type_in_words(JointType type) {
  switch (type) {
    case JointType::revolute:
      return "revolute";
    case JointType::continuous:
      return "continuous";
    case JointType::prismatic:
      return "prismatic";
    case JointType::fixed:
      break;
  }
  return "fixed";
}

double area_of(const BodyPoints& points) {
  double area = 0;
  for (const BodyPoints::LinkRange& range : points.links) area += range.area;
  return area;
}

}  // namespace

std::vector<std::string> oddities_of_place(const ViscosityField& field, const Arm& arm,
                                           const std::optional<JointLog>& log) {
  const Eigen::MatrixXd poses = poses_of(arm, log);
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(poses.rows());
  const Workspace& workspace = field.workspace();
  const Vec3 size =
      workspace.voxel_size * Vec3(workspace.dims.i, workspace.dims.j, workspace.dims.k);
  const Box box(workspace.origin, workspace.origin + size);
  ForwardKinematics kinematics(arm.robot);
  kinematics.update(poses.col(0).data(), at_rest.data(), arm.X_WB);
  std::vector<std::string> sentences = links_inside(field, arm, kinematics);
  bool met = false;
  for (Eigen::Index n = 0; n < poses.cols() && !met; ++n) {
    kinematics.update(poses.col(n).data(), at_rest.data(), arm.X_WB);
    met = touches(kinematics, arm.points, box);
  }
  if (!met) {
    sentences.push_back(fmt::format(
        "the arm never comes into the field, which reaches {}: is --base right?", in_words(box)));
  }
  return sentences;
}

std::string check_in_words(const ViscosityField& field, const Arm& arm,
                           const std::optional<JointLog>& log) {
  Report report;
  report.line("field", "{}; {} objects", grid_in_words(field.workspace()), field.objects().size());
  report.line("arm", "{}: {} links, {} joints that move, {} points on {:.3g} m²", arm.robot.name,
              arm.robot.links.size(), arm.robot.coordinates.size(), grouped(arm.points.count()),
              area_of(arm.points));
  for (Eigen::Index c = 0; c < static_cast<Eigen::Index>(arm.robot.coordinates.size()); ++c) {
    const Joint& joint = joint_of(arm, c);
    const char* unit = joint.type == JointType::prismatic ? "m" : "rad";
    const std::string limits =
        std::isfinite(joint.limits.lower) || std::isfinite(joint.limits.upper)
            ? fmt::format("{:.4g} to {:.4g} {}", joint.limits.lower, joint.limits.upper, unit)
            : "no limits";
    const std::string range = log ? fmt::format(", in the log {:.4g} to {:.4g}",
                                                log->q.row(c).minCoeff(), log->q.row(c).maxCoeff())
                                  : "";
    report.line("", "{:<16} {:<10} {}{}", joint.name, type_in_words(joint.type), limits, range);
  }
  report.line("limiter", "{}", arm.limiter);
  if (log) {
    report.line("log", "{} samples over {:.4g} s{}", grouped(log->t.size()),
                log->t.back() - log->t.front(), log->qd.size() > 0 ? ", with velocities" : "");
  }
  for (const std::string& remark : arm.remarks) report.line("odd", "{}", remark);
  if (arm.remarks.empty()) report.line("odd", "nothing");
  return std::move(report).text();
}

nlohmann::ordered_json check_as_json(const ViscosityField& field, const Arm& arm,
                                     const std::optional<JointLog>& log) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  Json json{{"objects", Json::array()},
            {"robot", arm.robot.name},
            {"links", arm.robot.links.size()},
            {"points", arm.points.count()},
            {"area", area_of(arm.points)},
            {"joints", Json::array()},
            {"samples", log ? Json(log->t.size()) : Json()},
            {"remarks", arm.remarks}};
  for (const FieldObject& object : field.objects()) json["objects"].push_back(object.name);
  for (Eigen::Index c = 0; c < static_cast<Eigen::Index>(arm.robot.coordinates.size()); ++c) {
    const Joint& joint = joint_of(arm, c);
    json["joints"].push_back({{"name", joint.name},
                              {"type", type_in_words(joint.type)},
                              {"lower", number(joint.limits.lower)},
                              {"upper", number(joint.limits.upper)},
                              {"log_lower", log ? Json(log->q.row(c).minCoeff()) : Json()},
                              {"log_upper", log ? Json(log->q.row(c).maxCoeff()) : Json()}});
  }
  return json;
}

}  // namespace vicinity::cli
