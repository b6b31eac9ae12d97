// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/study_setup.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "scenes/hot_cell.h"
#include "simulation/arm_model.h"
#include "vicinity/geometry/error.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity {
namespace {

constexpr std::size_t body_points = 150;
constexpr std::uint64_t tasks_seed = 20;

// Lengths of the demo's arm that no task brings near anything: their points would only cost time.
const std::vector<std::string> demo_excludes = {"shoulder", "upper_arm", "elbow"};

// The scene's robot block, with what the setup says over it. A robot that is given needs none of
// it.
SceneRobot placed_robot(const StudySetup& setup, const Scene& scene) {
  const bool own_arm = setup.robot.empty();
  if (own_arm && !scene.robot) {
    throw Error({.where = setup.name,
                 .what = "the scene has no robot",
                 .expected = "a block 'robot:' with a urdf"});
  }
  const bool demo = !setup.scene;
  SceneRobot robot = scene.robot && (own_arm || !demo) ? *scene.robot : SceneRobot();
  if (!own_arm) {
    robot.urdf = setup.robot;
    robot.exclude.clear();
  }
  if (own_arm && demo) robot.exclude = demo_excludes;
  if (setup.X_WB) robot.X_WB = *setup.X_WB;
  if (!setup.exclude.empty()) robot.exclude = setup.exclude;
  if (!setup.tool.empty()) robot.tool = setup.tool;
  return robot;
}

void check_step(double step_s) {
  const double ms = 1e3 * step_s;
  if (ms >= 0.999 && ms <= 5.001 && std::abs(ms - std::round(ms)) < 1e-9) return;
  throw Error({.where = "step",
               .what = "the time step of the physics cannot be used",
               .found = fmt::format("{:g} ms", ms),
               .expected = "1, 2, 3, 4 or 5 ms: beyond, contacts gain energy"});
}

}  // namespace

PreparedStudy prepare_study(const StudySetup& setup) {
  const bool demo = !setup.scene, own_arm = setup.robot.empty();
  const Scene scene = demo ? parse_scene(hot_cell_scene, {}, "the hot cell") : *setup.scene;
  const SceneRobot placed = placed_robot(setup, scene);
  PreparedStudy study;
  if (demo && own_arm) {
    study.urdf_text = hot_cell_arm_urdf;
  } else {
    study.urdf = placed.urdf;
  }
  RobotModel robot = demo && own_arm
                         ? parse_urdf(hot_cell_arm_urdf, placed.urdf).robot
                         : read_urdf(placed.urdf, {.package_folders = setup.packages}).robot;
  const int tool = placed.tool.empty() ? static_cast<int>(robot.links.size()) - 1
                                       : link_named(robot, placed.tool, "tool");
  study.words = fmt::format("{} in {}", robot.name, demo ? "the demo's hot cell" : setup.name);
  // Whether the arm can be simulated at all is known before anything is built.
  (void)arm_as_mjcf(robot, {});
  check_step(setup.step_s);
  study.place = build_workplace(scene, std::move(robot), placed.X_WB, tool, placed.exclude,
                                body_points, setup.step_s);
  study.tasks = !setup.tasks.empty() ? read_tasks(setup.tasks)
                : demo               ? parse_tasks(hot_cell_tasks, "the demo's tasks")
                                     : tasks_for(study.place, tasks_seed);
  fit_tasks(study.place, study.tasks, tasks_seed);
  return study;
}

}  // namespace vicinity
