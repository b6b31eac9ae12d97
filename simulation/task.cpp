// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/task.h"

#include <yaml-cpp/yaml.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "simulation/position_aids.h"
#include "vicinity/drag/approach.h"
#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"
#include "vicinity/teleop/lead.h"

namespace vicinity {
namespace {

constexpr double stand_off = 0.02;  // of tasks_for() [m]
constexpr double run_up = 0.2;      // [m]
constexpr int starts_tried = 200;

class TaskReader {
 public:
  explicit TaskReader(std::string where) : where_(std::move(where)) {}

  Task read(const YAML::Node& node) const {
    static const std::vector<std::string> keys{"name",  "says", "path",  "points", "across",
                                               "speed", "stop", "sight", "haste",  "limit"};
    if (!node.IsMap()) fail(node, "this is no task", "keys and values");
    for (const auto& entry : node) {
      const auto key = entry.first.as<std::string>("");
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      fail(entry.first, "a task has no key '" + key + "'", "", nearest_word(key, keys));
    }
    Task task;
    if (!node["name"] || !node["path"]) fail(node, "a task lacks its name or its path", "both");
    task.name = node["name"].as<std::string>("");
    task.says = node["says"].as<std::string>(task.name);
    if (!node["path"].IsSequence() || node["path"].size() < 2) {
      fail(node["path"], "a path has two points or more", "[[x, y, z], [x, y, z]]");
    }
    for (const auto& point : node["path"]) task.intent.path_W.push_back(triple(point));
    if (node["points"]) task.tool_z_W = direction(node["points"]);
    if (node["across"]) task.tool_x_W = direction(node["across"]);
    if (node["sight"]) task.intent.sight_W = direction(node["sight"]);
    if (node["speed"]) task.intent.speed = positive(node["speed"]);
    if (node["limit"]) task.limit_s = positive(node["limit"]);
    if (node["stop"]) {
      const auto word = node["stop"].as<std::string>("");
      if (word != "feel" && word != "sight") fail(node["stop"], "no such stop", "feel or sight");
      task.intent.stops_by_feel = word == "feel";
    }
    if (node["haste"]) task.intent.careful = !node["haste"].as<bool>(false);
    if (task.tool_z_W.cross(task.tool_x_W).norm() < 0.1) {
      fail(node, "the tool points along its own x", "'points' and 'across' that differ");
    }
    return task;
  }

  [[noreturn]] void fail(const YAML::Node& node, std::string what, std::string expected,
                         std::string hint = {}) const {
    const int line = node.Mark().line;
    throw Error({.where = line < 0 ? where_ : where_ + ":" + std::to_string(line + 1),
                 .what = std::move(what),
                 .expected = std::move(expected),
                 .hint = std::move(hint)});
  }

 private:
  Vec3 triple(const YAML::Node& node) const {
    if (!node.IsSequence() || node.size() != 3) fail(node, "no point", "[x, y, z]");
    Vec3 v;
    for (std::size_t n = 0; n < 3; ++n) {
      v[static_cast<Eigen::Index>(n)] = node[n].as<double>(std::nan(""));
    }
    if (!v.allFinite()) fail(node, "no point", "three finite numbers");
    return v;
  }
  Vec3 direction(const YAML::Node& node) const {
    const Vec3 v = triple(node);
    if (v.norm() < 1e-6) fail(node, "no direction", "[x, y, z], not all zero");
    return v.normalized();
  }
  double positive(const YAML::Node& node) const {
    const double value = node.as<double>(std::nan(""));
    if (!(value > 0) || !std::isfinite(value)) fail(node, "not a positive number", "");
    return value;
  }

  std::string where_;
};

Eigen::Matrix3d orientation_of(const Task& task) {
  Eigen::Matrix3d R;
  R.col(2) = task.tool_z_W;
  R.col(1) = task.tool_z_W.cross(task.tool_x_W).normalized();
  R.col(0) = R.col(1).cross(R.col(2));
  return R;
}

// Joints that hold the tool so, from a guess; absent where the guess leads nowhere.
std::optional<AxisVector> solved(const Workplace& place, const Vec3& p_WT,
                                 const Eigen::Matrix3d& R_WT, AxisVector q) {
  ForwardKinematics kinematics(place.robot);
  const AxisVector still = AxisVector::Zero(q.size());
  const auto tool = static_cast<std::size_t>(place.tool_link);
  for (int step = 0; step < 60; ++step) {
    kinematics.update(q.data(), still.data(), place.X_WB);
    Eigen::Matrix<double, 6, 1> missing;
    const Eigen::AngleAxisd turn(R_WT * kinematics.R_WL(tool).transpose());
    missing << p_WT - kinematics.p_WL(tool), turn.angle() * turn.axis();
    const bool there = missing.head<3>().norm() < 1e-4 && missing.tail<3>().norm() < 1e-3;
    if (there) {
      for (Eigen::Index c = 0; c < q.size(); ++c) {
        const JointLimits& limits = place.robot
                                        .joints[static_cast<std::size_t>(
                                            place.robot.coordinates[static_cast<std::size_t>(c)])]
                                        .limits;
        const double room = std::isfinite(limits.upper - limits.lower) ? 0.05 : 0;
        if (q[c] < limits.lower + room || q[c] > limits.upper - room) return std::nullopt;
      }
      return q;
    }
    const Jacobian J = link_jacobian(place.robot, kinematics, tool);
    Eigen::Matrix<double, 6, 6> square = J * J.transpose();
    square.diagonal().array() += 1e-3;
    const double far = std::max(1.0, missing.norm() / 0.5);
    const Eigen::Matrix<double, 6, 1> weights = square.llt().solve(missing / far);
    q += J.transpose() * weights;
  }
  return std::nullopt;
}

// How well the arm goes the way: its least distance from anything, up to 30 mm, and with less
// weight how far it stays from where it cannot move in some direction. Below zero where it cannot
// go it.
double ease_of_the_way(const Workplace& place, const Task& task, const AxisVector& q) {
  constexpr double step_m = 0.0005;  // of 0.5 m/s at 1 kHz
  Lead lead(place.robot, AxisKind::cartesian, place.tool_link, place.X_WB);
  AxisVector x = task.intent.path_W.front();
  lead.start(q, x);
  ArmDistance distance(place.robot, place.points, place.distance, place.distance_clearance);
  ForwardKinematics kinematics(place.robot);
  const AxisVector still = AxisVector::Zero(q.size());
  double room = 0.03, lever = 1;
  AxisVector last = q;
  for (std::size_t leg = 1; leg < task.intent.path_W.size(); ++leg) {
    const Vec3 from = task.intent.path_W[leg - 1], to = task.intent.path_W[leg];
    const int steps = std::max(1, static_cast<int>((to - from).norm() / step_m));
    for (int n = 0; n <= steps; ++n) {
      x = Vec3(from + (to - from) * n / steps);
      lead.follow(x, 1);
      if ((lead.p_WT() - Vec3(x)).norm() > 0.002) return -1;
      if ((lead.q() - last).cwiseAbs().maxCoeff() > 0.1) return -1;
      last = lead.q();
      if (n % 20 != 0 && n < steps) continue;
      distance.look(lead.q().data(), place.X_WB);
      if (const NearPoint* nearest = distance.nearest()) {
        room = std::min(room, nearest->distance_m);
      }
      kinematics.update(lead.q().data(), still.data(), place.X_WB);
      const Jacobian J =
          link_jacobian(place.robot, kinematics, static_cast<std::size_t>(place.tool_link));
      const Eigen::Matrix<double, 6, 6> square = J * J.transpose();
      const double least =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(square, Eigen::EigenvaluesOnly)
              .eigenvalues()[0];
      lever = std::min(lever, std::sqrt(std::max(least, 0.0)));
    }
  }
  return room < 0.0005 ? -1 : room + 0.1 * lever;
}

AxisVector random_joints(const RobotModel& robot, SeededNoise& random) {
  AxisVector q(static_cast<Eigen::Index>(robot.coordinates.size()));
  for (Eigen::Index c = 0; c < q.size(); ++c) {
    const JointLimits& limits =
        robot.joints[static_cast<std::size_t>(robot.coordinates[static_cast<std::size_t>(c)])]
            .limits;
    const double lower = std::max(limits.lower, -std::numbers::pi);
    const double upper = std::min(limits.upper, std::numbers::pi);
    q[c] = lower + (upper - lower) * random.uniform();
  }
  return q;
}

std::optional<AxisVector> start_of(const Workplace& place, const Task& task, SeededNoise& random) {
  std::optional<AxisVector> best;
  double easiest = 0;
  for (int n = 0, good = 0; n < starts_tried && good < 12; ++n) {
    const auto q = solved(place, task.intent.path_W.front(), orientation_of(task),
                          random_joints(place.robot, random));
    if (!q) continue;
    const double ease = ease_of_the_way(place, task, *q);
    if (ease >= 0) ++good;
    if (ease > easiest) {
      easiest = ease;
      best = q;
    }
  }
  return best;
}

}  // namespace

std::vector<Task> parse_tasks(std::string_view text, const std::string& where) {
  const TaskReader reader(where);
  YAML::Node root;
  try {
    root = YAML::Load(std::string(text));
  } catch (const YAML::Exception& error) {
    throw Error({.where = where, .what = "this is no YAML", .found = error.what()});
  }
  if (!root.IsMap() || !root["tasks"] || !root["tasks"].IsSequence() || root["tasks"].size() == 0) {
    reader.fail(root, "there are no tasks", "a list 'tasks:'");
  }
  std::vector<Task> tasks;
  for (const auto& node : root["tasks"]) {
    tasks.push_back(reader.read(node));
    for (std::size_t n = 0; n + 1 < tasks.size(); ++n) {
      if (tasks[n].name == tasks.back().name) reader.fail(node, "two tasks have one name", "");
    }
  }
  return tasks;
}

std::vector<Task> read_tasks(const std::filesystem::path& path) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw Error({.where = path.string(), .what = "the tasks cannot be read"});
  return parse_tasks(text, path.string());
}

std::vector<Task> tasks_for(const Workplace& place, std::uint64_t seed) {
  constexpr int tries = 20000;
  constexpr std::size_t wanted = 2;  // objects
  SeededNoise random(seed);
  ForwardKinematics kinematics(place.robot);
  ArmDistance distance(place.robot, place.points, place.distance, place.distance_clearance);
  std::vector<Task> tasks;
  std::vector<std::uint16_t> taken;
  for (int n = 0; n < tries && taken.size() < wanted; ++n) {
    // An arm at random, whose tool happens to be near something and points at it.
    const AxisVector q = random_joints(place.robot, random);
    distance.look(q.data(), place.X_WB);
    const auto tool = static_cast<std::size_t>(place.tool_link);
    const Pose X_WT = distance.kinematics().X_WL(tool);
    const NearPoint* const nearest = distance.nearest();
    if (nearest == nullptr || nearest->distance_m < stand_off) continue;
    const FieldSample here = place.distance.at(nearest->p_W);
    const Vec3 towards_W = towards_surface(place.distance, nearest->p_W);
    if (towards_W.dot(X_WT.linear().col(2)) < 0.7) continue;
    if (std::find(taken.begin(), taken.end(), here.record.object) != taken.end()) continue;
    const std::string& object = place.distance.objects()[here.record.object].name;
    Task task;
    task.name = "approach_" + object;
    task.says = "stop 20 mm before '" + object + "'";
    const Vec3 goal = X_WT.translation() + (nearest->distance_m - stand_off) * towards_W;
    task.intent.path_W = {goal - run_up * towards_W, goal};
    task.intent.sight_W = towards_W;  // no camera: depth is what is not known
    task.intent.stops_by_feel = true;
    task.tool_z_W = X_WT.linear().col(2);
    task.tool_x_W = X_WT.linear().col(0);
    if (!start_of(place, task, random)) continue;
    Task back = task;
    back.name = "retreat_" + object;
    back.says = "away from '" + object + "' in haste";
    std::swap(back.intent.path_W[0], back.intent.path_W[1]);
    back.intent.speed = 0.5;
    back.intent.careful = back.intent.stops_by_feel = false;
    taken.push_back(here.record.object);
    tasks.push_back(std::move(task));
    tasks.push_back(std::move(back));
  }
  if (!tasks.empty()) return tasks;
  throw Error({.where = "robot '" + place.robot.name + "'",
               .what = "from where it stands its tool reaches no object of the scene freely",
               .hint = "another base, or tasks of your own with --tasks FILE"});
}

void fit_tasks(const Workplace& place, std::vector<Task>& tasks, std::uint64_t seed) {
  for (std::size_t n = 0; n < tasks.size(); ++n) {
    SeededNoise random(seed_for(seed, n));
    const auto q = start_of(place, tasks[n], random);
    if (!q) {
      throw Error({.where = "task '" + tasks[n].name + "'",
                   .what = "the arm '" + place.robot.name +
                           "' cannot lead its tool along that path without touching or leaving "
                           "its limits",
                   .hint = "another base or path, or leaving the task out"});
    }
    tasks[n].q_start = *q;
  }
}

}  // namespace vicinity
