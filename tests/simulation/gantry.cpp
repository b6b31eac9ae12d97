// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/gantry.h"

#include "vicinity/mesh/primitive.h"
#include "vicinity/robot/urdf_file.h"

namespace vicinity {
namespace {

std::string slide(const std::string& name, const std::string& parent, const std::string& axis,
                  const std::string& inertial, const std::string& surface) {
  return "<joint name=\"" + name + "\" type=\"prismatic\"><parent link=\"" + parent +
         "\"/><child link=\"" + name + "_slide\"/><axis xyz=\"" + axis +
         "\"/><limit lower=\"-1\" upper=\"1\" velocity=\"2\" effort=\"2000\"/></joint>\n<link "
         "name=\"" +
         name + "_slide\">" + inertial + surface + "</link>\n";
}

}  // namespace

std::string gantry_urdf(bool with_inertia) {
  const std::string inertia =
      "<inertia ixx=\"0.001\" ixy=\"0\" ixz=\"0\" iyy=\"0.001\" iyz=\"0\" "
      "izz=\"0.001\"/></inertial>";
  const std::string heavy = with_inertia ? "<inertial><mass value=\"1.5\"/>" + inertia : "";
  const std::string tool = with_inertia ? "<inertial><mass value=\"0.8\"/>" + inertia : "";
  return "<robot name=\"gantry\">\n<link name=\"frame\"/>\n" +
         slide("x", "frame", "1 0 0", heavy, "") + slide("y", "x_slide", "0 1 0", heavy, "") +
         slide("z", "y_slide", "0 0 1", tool,
               "<collision><geometry><sphere radius=\"0.02\"/></geometry></collision>") +
         "</robot>\n";
}

RobotModel gantry(bool with_inertia) {
  return parse_urdf(gantry_urdf(with_inertia), "gantry.urdf").robot;
}

Scene block_scene() {
  Scene scene;
  scene.voxel_size = 0.01;
  SceneObject block{.name = "block", .shape = primitive::box({0.3, 0.3, 0.2})};
  block.X_WO.translation() = Vec3(0.002, 0.002, -0.1);
  block.m = 2;
  block.q = 3;
  scene.objects.push_back(std::move(block));
  return scene;
}

const Workplace& block_workplace() {
  static const Workplace place =
      build_workplace(block_scene(), gantry(), Pose::Identity(), 3, {}, 40, 0.002);
  return place;
}

std::vector<Task> block_tasks() {
  return parse_tasks(
      "tasks:\n"
      "  - {name: approach, path: [[0, 0, 0.2], [0, 0, 0.04]], points: [0, 0, 1], speed: 0.2,\n"
      "     sight: [0, 0, 1], stop: feel, limit: 6}\n"
      "  - {name: retreat, path: [[0, 0, 0.04], [0, 0, 0.2]], points: [0, 0, 1], speed: 0.5,\n"
      "     sight: [0, 0, 1], haste: true, limit: 6}\n",
      "block tasks");
}

}  // namespace vicinity
