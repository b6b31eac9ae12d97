// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/arm_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

std::string numbers(const Vec3& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}

std::string placed(const Pose& pose) {
  const Eigen::Quaterniond turn(pose.linear());
  return fmt::format("pos=\"{}\" quat=\"{:.17g} {:.17g} {:.17g} {:.17g}\"",
                     numbers(pose.translation()), turn.w(), turn.x(), turn.y(), turn.z());
}

// Names come from files of all kinds: only what XML would read as its own is replaced.
std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) {
    text += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return text;
}

// A link that turns or slides must weigh something, itself or in what is fixed to it.
bool weighs(const RobotModel& robot, std::size_t link) {
  if (robot.links[link].inertia) return true;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    if (static_cast<std::size_t>(robot.joints[j].parent) == link &&
        robot.joints[j].type == JointType::fixed && weighs(robot, j + 1)) {
      return true;
    }
  }
  return false;
}

void demand_inertia(const RobotModel& robot) {
  std::string lacking;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    if (robot.joints[j].type == JointType::fixed || weighs(robot, j + 1)) continue;
    lacking += (lacking.empty() ? "'" : ", '") + robot.links[j + 1].name + "'";
  }
  if (lacking.empty()) return;
  throw Error({.where = "robot '" + robot.name + "'",
               .what = "links that move state no inertia, so that nothing tells how they move",
               .found = "none for " + lacking,
               .expected = "<inertial> with a mass above zero and an <inertia>",
               .hint = "the URDF that the arm's maker ships for simulation"});
}

class Writer {
 public:
  Writer(const RobotModel& robot, const ArmModelOptions& options)
      : robot_(robot), options_(options) {}

  std::string text() {
    text_ = fmt::format(
        "<mujoco model=\"workplace\">\n"
        "<compiler angle=\"radian\" balanceinertia=\"true\"/>\n"
        // Contacts of a metal part: stiff, little bounce; no time constant below two steps.
        "<default><geom solref=\"{:.6g} 1\" solimp=\"0.95 0.99 0.0005\" friction=\"0.3\"/>"
        "</default>\n"
        "<option timestep=\"{:.17g}\"/>\n<size njmax=\"800\" nconmax=\"200\"/>\n<worldbody>\n",
        std::max(0.005, 2 * options_.step_s), options_.step_s);
    for (int n = 0; n < options_.contact_boxes; ++n) {
      text_ += fmt::format(
          "<geom name=\"box_{}\" type=\"box\" size=\"1 1 1\" contype=\"0\" conaffinity=\"0\"/>\n",
          n);
    }
    body(0, options_.X_WB, nullptr);
    text_ += "</worldbody>\n</mujoco>\n";
    return std::move(text_);
  }

 private:
  void body(std::size_t link, const Pose& X_PL, const Joint* joint) {
    const Link& here = robot_.links[link];
    text_ += fmt::format("<body name=\"{}\" {}>\n", escaped(here.name), placed(X_PL));
    if (joint && joint->type != JointType::fixed) {
      text_ +=
          fmt::format("<joint name=\"{}\" type=\"{}\" axis=\"{}\" armature=\"{:.17g}\"/>\n",
                      escaped(joint->name), joint->type == JointType::prismatic ? "slide" : "hinge",
                      numbers(joint->axis_J), options_.armature);
    }
    if (here.inertia) inertia(*here.inertia);
    const bool may_touch = link > 0 && moved(link);
    for (const Capsule& capsule : may_touch ? capsules_of(here) : std::vector<Capsule>()) {
      const bool ball = (capsule.to - capsule.from).norm() < 1e-9;
      text_ += ball ? fmt::format("<geom type=\"sphere\" pos=\"{}\" ", numbers(capsule.from))
                    : fmt::format("<geom type=\"capsule\" fromto=\"{} {}\" ", numbers(capsule.from),
                                  numbers(capsule.to));
      text_ += fmt::format("size=\"{:.17g}\" contype=\"2\" conaffinity=\"1\"/>\n", capsule.radius);
    }
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      if (static_cast<std::size_t>(robot_.joints[j].parent) != link) continue;
      body(j + 1, robot_.joints[j].X_PJ, &robot_.joints[j]);
    }
    text_ += "</body>\n";
  }

  void inertia(const LinkInertia& inertia) {
    // MuJoCo wants the tensor in the link's axes, about the centre of mass.
    const Eigen::Matrix3d& R = inertia.X_LC.linear();
    const Eigen::Matrix3d I = R * inertia.about_centre * R.transpose();
    text_ += fmt::format(
        "<inertial pos=\"{}\" mass=\"{:.17g}\" fullinertia=\"{:.17g} {:.17g} {:.17g} {:.17g} "
        "{:.17g} {:.17g}\"/>\n",
        numbers(inertia.X_LC.translation()), inertia.mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1),
        I(0, 2), I(1, 2));
  }

  bool moved(std::size_t link) const {
    for (; link > 0; link = static_cast<std::size_t>(robot_.joints[link - 1].parent)) {
      if (robot_.joints[link - 1].type != JointType::fixed) return true;
    }
    return false;
  }

  const RobotModel& robot_;
  const ArmModelOptions& options_;
  std::string text_;
};

}  // namespace

std::vector<Capsule> capsules_of(const Link& link) {
  std::vector<Capsule> capsules;
  for (const LinkGeometry& geometry : link.geometries) {
    const Box box = geometry.mesh.bounds();
    if (box.isEmpty()) continue;
    const Vec3 half = 0.5 * box.sizes(), centre = box.center();
    std::array<int, 3> by_length{0, 1, 2};
    std::sort(by_length.begin(), by_length.end(),
              [&](int a, int b) { return half[a] > half[b] || (half[a] == half[b] && a < b); });
    // A plate has no thickness to speak of: one millimetre then.
    const double radius = std::max(half[by_length[2]], 5e-4);
    const Vec3 along = Vec3::Unit(by_length[0]) * std::max(half[by_length[0]] - radius, 0.0);
    const double across = std::max(half[by_length[1]] - radius, 0.0);
    const int rows = across > 0.05 * radius ? static_cast<int>(std::ceil(across / radius)) + 1 : 1;
    for (int row = 0; row < rows; ++row) {
      const double at = rows > 1 ? across * (2.0 * row / (rows - 1) - 1) : 0;
      const Vec3 middle = centre + at * Vec3::Unit(by_length[1]);
      capsules.push_back({middle - along, middle + along, radius});
    }
  }
  return capsules;
}

std::string arm_as_mjcf(const RobotModel& robot, const ArmModelOptions& options) {
  check(robot);
  demand_inertia(robot);
  return Writer(robot, options).text();
}

}  // namespace vicinity
