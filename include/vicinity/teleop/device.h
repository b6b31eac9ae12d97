// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The device in the operator's hand: what of it decides how much drag it can render.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vicinity/teleop/axes.h"

namespace vicinity {

/// What is not known is absent (empty), never guessed. A list has one value, which then counts for
/// every axis, or one for each axis.
struct Device {
  std::string name;
  AxisKind axes = AxisKind::cartesian;
  int axis_count = 3;                    ///< 3 where cartesian
  std::vector<double> mass;              ///< at least this much is felt [kg or kg·m²]
  std::vector<double> physical_damping;  ///< b: at least this much    [N·s/m or N·m·s/rad]
  std::vector<double> damping_ceiling;   ///< of `device` mode: beyond it, it buzzes [as above]
  std::vector<double> encoder_step;      ///< Delta: at most this much [m or rad]
  std::vector<double> dry_friction;      ///< f_c: at least this much  [N or N·m]
  std::optional<double> sample_period;   ///< T [s]
  std::optional<double> force_limit;     ///< on the norm of the force at the handle [N]
  std::vector<double> torque_limits;     ///< on each joint [N·m]
};

/// Devices whose makers or public toolkits state a damping ceiling, sorted by name.
std::span<const Device> known_devices();

/// One of known_devices(). Errors: throws Error, with all of their names, for another.
const Device& known_device(std::string_view name);

/// A device of one's own, from a YAML file whose keys are the fields of Device:
///
///   name: bench arm
///   axes: joints                       # or cartesian, the default
///   axis_count: 6                      # joints only
///   physical_damping: [0.4, 0.4, 0.3, 0.1, 0.1, 0.05]
///   encoder_step: 1.0e-5               # one value counts for every axis
///   dry_friction: 0.02
///   sample_period: 0.001
///   torque_limits: [4, 4, 3, 1, 1, 0.5]
///
/// `like: NAME` first copies one of known_devices(); what else is stated then replaces its values.
/// Errors: throws Error for a file that cannot be read or is no YAML, an unknown key (naming the
/// nearest), a value that is not a positive finite number (mass, damping and friction may be
/// zero), or a list that fits neither one value nor the axes.
Device read_device(const std::filesystem::path& file);

/// By the word a user gives: a file where it ends in .yaml or .yml, else a known name. Errors: as
/// read_device() and known_device().
Device find_device(const std::string& name_or_file);

/// As read_device(), from text. @param where  what errors call it
Device parse_device(const std::string& yaml, const std::string& where);

}  // namespace vicinity
