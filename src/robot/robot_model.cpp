// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/robot/robot_model.h"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"

namespace vicinity {
namespace {

template <class Named>
std::optional<int> find(const std::vector<Named>& all, std::string_view name) noexcept {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

}  // namespace

std::optional<int> RobotModel::find_link(std::string_view wanted) const noexcept {
  return find(links, wanted);
}

std::optional<int> RobotModel::find_joint(std::string_view wanted) const noexcept {
  return find(joints, wanted);
}

int link_named(const RobotModel& robot, const std::string& name, const std::string& where) {
  if (const auto link = robot.find_link(name)) return *link;
  std::vector<std::string> links;
  for (const Link& link : robot.links) links.push_back(link.name);
  throw Error({.where = where,
               .what = "the robot has no such link",
               .found = "'" + name + "'",
               .expected = "a link of '" + robot.name + "'",
               .hint = nearest_word(name, links)});
}

void check(const RobotModel& robot) {
  const auto refuse = [&](std::string where, std::string what) {
    throw Error({.where = std::move(where), .what = std::move(what)});
  };
  if (robot.links.size() != robot.joints.size() + 1) {
    refuse(fmt::format("robot '{}'", robot.name),
           fmt::format("{} links and {} joints do not make a tree", robot.links.size(),
                       robot.joints.size()));
  }
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    const std::string where = fmt::format("joint '{}'", joint.name);
    if (joint.parent < 0 || static_cast<std::size_t>(joint.parent) > i) {
      refuse(where, "its parent link does not come before the link it moves");
    }
    if (!joint.X_PJ.matrix().allFinite() || !std::isfinite(joint.multiplier) ||
        !std::isfinite(joint.offset)) {
      refuse(where, "a number is not finite");
    }
    if (joint.type == JointType::fixed) continue;
    // The kinematics turn about this axis without normalising it again.
    if (!(std::abs(joint.axis_J.norm() - 1) < 1e-12))
      refuse(where, "its axis is not a unit vector");
    if (joint.coordinate < -1 || joint.coordinate >= static_cast<int>(robot.coordinates.size())) {
      refuse(where, fmt::format("there is no coordinate {}", joint.coordinate));
    }
  }
  for (const int joint : robot.coordinates) {
    if (joint < 0 || static_cast<std::size_t>(joint) >= robot.joints.size()) {
      refuse(fmt::format("robot '{}'", robot.name), "a coordinate belongs to no joint");
    }
  }
}

}  // namespace vicinity
