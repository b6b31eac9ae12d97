// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What the operator is asked to do, for any arm: a way of the tool, and how it ends.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/operator.h"
#include "simulation/workplace.h"
#include "vicinity/teleop/axes.h"

namespace vicinity {

struct Task {
  std::string name, says;
  Intent intent;
  Vec3 tool_z_W = -Vec3::UnitZ();  ///< where the tool points
  Vec3 tool_x_W = Vec3::UnitX();   ///< across it, made square to tool_z_W
  double limit_s = 8;              ///< who is not done by then has failed [s]
  AxisVector q_start = {};         ///< found by fit_tasks()
};

/// Tasks as a YAML file:
///
///   tasks:
///     - name: approach
///       says: stop 20 mm before the cylinder
///       path: [[0.28, 0.78, 0.8], [0.28, 0.58, 0.8]]   of the tool, in W [m]
///       points: [0, -1, 0]      where the tool points; default: down
///       across: [0, 0, 1]       the tool's own x; default: along x
///       speed: 0.25             mean [m/s]; default 0.25
///       sight: [0, 1, 0]        along the line of sight; default: along y
///       stop: feel              or sight, the default
///       haste: false            true: does not slow down for what he feels
///       limit: 8                [s]
///
/// Errors: throws Error for text that is no such list, unknown keys and numbers that are none.
std::vector<Task> parse_tasks(std::string_view text, const std::string& where);
std::vector<Task> read_tasks(const std::filesystem::path& path);

/// Tasks of a scene that has none of its own: for each of a few objects, nearest first, approach
/// and stop 20 mm before it, and retreat in haste. Errors: throws Error where the arm reaches
/// nothing.
std::vector<Task> tasks_for(const Workplace& place, std::uint64_t seed);

/// Finds a start for each task: joints from which the arm leads its tool along the whole way within
/// its limits and without touching, of several tries the one with most room.
/// Errors: throws Error that names a task which this arm cannot do here.
void fit_tasks(const Workplace& place, std::vector<Task>& tasks, std::uint64_t seed);

}  // namespace vicinity
