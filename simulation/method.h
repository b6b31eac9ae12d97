// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What is compared: the aids by name, each with the one setting that it is tuned by.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/operator.h"
#include "simulation/position_aids.h"
#include "simulation/workplace.h"
#include "vicinity/drag/drag.h"
#include "vicinity/teleop/limiter.h"
#include "vicinity/teleop/tick.h"

namespace vicinity {

enum class MethodKind : std::uint8_t { none, potential, fixture, scaling, drag };

struct Method {
  std::string name;
  std::string says;  ///< a line for people
  MethodKind kind = MethodKind::none;
  Cue cue = Cue::none;  ///< by which its user learns how near he is

  // Drag.
  std::string coding = "paper";
  std::string memory = "none";
  DragDirection direction = DragDirection::all;
  bool keeps_distance = false;
  LimiterMode mode = LimiterMode::device;

  /// The setting: gain, stiffness or threshold; and what tuning tries.
  std::string setting_name = {};
  double setting = 0;
  std::vector<double> tried = {};
};

/// All of them, in the order of the report: none, potential_field, virtual_fixture, speed_scaling;
/// the paper's all_I_none ... all_II_short (coding I or II of table 2, and memory); ours: closing,
/// distance, jnd, rising.
const std::vector<Method>& methods();

/// Errors: throws Error, with the nearest name, for another.
const Method& method_named(std::string_view name);

/// An aid, and all that it needs to live.
struct FittedAid {
  std::unique_ptr<Teleoperation> teleoperation;  ///< of a drag
  std::unique_ptr<Aid> aid;
};

/// @param place     outlives it
/// @param period_s  of whoever asks it: the master's, or the slave's where it is remote
FittedAid fit_aid(const Workplace& place, const Method& method, const Device& device,
                  double period_s);

}  // namespace vicinity
