// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/arm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "arguments.h"
#include "drag_words.h"
#include "scenes/hot_cell.h"
#include "vicinity/geometry/error.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/teleop/device.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::cli {
namespace {

constexpr double usual_rate = 1000;
// A tick that comes after this many periods or more came too late.
constexpr double late_periods = 1.5;

// What the scene says, and over it what the command line says.
SceneRobot placed_robot(const ArmOptions& options) {
  SceneRobot robot;
  if (!options.scene.empty()) {
    const Scene scene = read_scene(options.scene);
    if (!scene.robot) {
      throw Error({.where = options.scene.string(),
                   .what = "the scene has no robot",
                   .expected = "a block 'robot:' with a urdf"});
    }
    robot = *scene.robot;
  }
  if (!options.robot.empty()) robot.urdf = options.robot;
  if (!options.base.empty()) robot.X_WB = pose_from("--base", options.base);
  if (!options.exclude.empty()) robot.exclude = words_from(options.exclude);
  if (!options.tool.empty()) robot.tool = options.tool;
  if (options.points_per_m2) robot.points_per_m2 = *options.points_per_m2;
  if (robot.urdf.empty()) {
    throw Error({.what = "no robot is given", .hint = "--robot URDF, or --scene SCENE with one"});
  }
  return robot;
}

MasterArm master_from(const std::string& text) {
  const auto n = numbers_from("--master", text, 4);
  MasterArm master;
  master.gain = n[0];
  master.attenuation = n[1];
  master.lever = n[2];
  master.torque_constant = n[3];
  return checked(master);
}

// The device that the drag is limited for, and the period that it or the user asks for.
void add_device(const ArmOptions& options, Arm& arm) {
  constexpr std::array modes = {std::pair{"strict", LimiterMode::strict},
                                std::pair{"device", LimiterMode::device}};
  const LimiterMode mode = one_of("--mode", options.mode, modes);
  if (options.device.empty() && mode == LimiterMode::device) {
    throw Error({.where = "--mode",
                 .what = "a mode needs a device to limit the drag for",
                 .hint = "--device NAME or FILE.yaml"});
  }
  TeleoperationOptions& teleoperation = arm.teleoperation;
  double rate = options.rate.value_or(usual_rate);
  arm.limiter = "none: drag as the field has it, and no promise that a device renders it stably";
  if (!options.device.empty()) {
    const Device device = find_device(options.device);
    teleoperation.limiter = limiter_options(device, mode);
    if (!options.rate && device.sample_period) rate = 1 / *device.sample_period;
    arm.limiter = fmt::format("{} mode, device '{}'", to_string(mode), device.name);
  }
  if (!(rate >= 1 && rate <= 100'000)) {
    throw Error({.where = "--rate",
                 .what = "ticks cannot come so often or so seldom",
                 .found = fmt::format("{:g} Hz", rate),
                 .expected = "1 to 100000 Hz"});
  }
  arm.rate = rate;
  teleoperation.longest_period_s = late_periods / rate;
}

// Why there is nothing of the arm to feel with.
[[noreturn]] void refuse_pointless(const Arm& arm, const SceneRobot& placed, bool by_density) {
  if (by_density && placed.points_per_m2 == 0) {
    throw Error({.where = placed.urdf.string(),
                 .what = "nothing of the arm can feel",
                 .found = "0 body points per m²",
                 .expected = "a density above zero",
                 .hint = "--points-per-m2 2000"});
  }
  const auto left_out = std::ranges::find_if(
      arm.remarks, [](const std::string& remark) { return remark.ends_with("left out"); });
  const std::string found = left_out == arm.remarks.end() ? "" : *left_out;
  const bool mesh_is_missing = found.find("is not there") != found.npos;
  throw Error({.where = placed.urdf.string(),
               .what = "no link has a surface, so that nothing of the arm can feel",
               .found = found,
               .hint = mesh_is_missing           ? "--packages FOLDER, where its meshes are"
                       : !placed.exclude.empty() ? "fewer links in --exclude"
                                                 : "links with shapes of some area"});
}

Arm fit_out(RobotLoad load, const SceneRobot& placed, const ArmOptions& options) {
  Arm arm = bodiless_arm(options);
  arm.X_WB = placed.X_WB;
  arm.robot = std::move(load.robot);
  arm.remarks = std::move(load.remarks);
  if (!placed.tool.empty()) {
    arm.teleoperation.tool_link = link_named(arm.robot, placed.tool, "--tool");
  }
  BodyPointOptions points;
  points.points_per_m2 = placed.points_per_m2;
  points.total = options.points;
  points.exclude = placed.exclude;
  arm.points = sample_body_points(arm.robot, points);
  if (arm.points.count() == 0) refuse_pointless(arm, placed, !options.points);
  check_fit(arm.robot, arm.teleoperation);
  return arm;
}

}  // namespace

std::vector<std::filesystem::path> files_of(const ArmOptions& options) {
  std::vector<std::filesystem::path> files = {options.robot, options.scene};
  if (options.robot.empty() && !options.scene.empty()) {
    if (const auto robot = read_scene(options.scene).robot) files.push_back(robot->urdf);
  }
  const std::filesystem::path device(options.device);  // or a name: find_device()
  if (device.extension() == ".yaml" || device.extension() == ".yml") files.push_back(device);
  return files;
}

Arm bodiless_arm(const ArmOptions& options) {
  Arm arm;
  arm.teleoperation.memory = named_memory(options.memory);
  arm.teleoperation.direction = direction_from(options.direction);
  arm.teleoperation.traversal = traversal_from(options.traversal);
  if (!options.master.empty()) arm.teleoperation.master = master_from(options.master);
  add_device(options, arm);
  return arm;
}

Arm read_arm(const ArmOptions& options) {
  const SceneRobot placed = placed_robot(options);
  return fit_out(read_urdf(placed.urdf, {.package_folders = options.packages}), placed, options);
}

Arm hot_cell_arm(const ArmOptions& options) {
  const SceneRobot placed = *parse_scene(hot_cell_scene, {}, "the hot cell").robot;
  return fit_out(parse_urdf(hot_cell_arm_urdf, placed.urdf), placed, options);
}

const std::string& joint_name(const RobotModel& robot, std::size_t coordinate) {
  return robot.joints[static_cast<std::size_t>(robot.coordinates[coordinate])].name;
}

}  // namespace vicinity::cli
