// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity replay: a joint log through the tick.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "replay/arm.h"

namespace vicinity::cli {

struct ReplayOptions {
  std::filesystem::path field;
  ArmOptions arm;
  std::string coding;                ///< in place of every object's; empty: the field's
  std::filesystem::path trajectory;  ///< joint log
  std::string columns;               ///< "t=Time*0.001,joint_1=Position1,..."
  std::optional<double> duration;    ///< there and back until then [s]; else the log once
  bool real_time = false;
  bool check_only = false;
  std::filesystem::path output;  ///< .mcap, .jsonl; else CSV; empty: the summary alone
  std::filesystem::path plot;    ///< .svg or .png; empty: none
  bool json = false;
};

/// Interrupted, it writes what it has so far.
/// @return 0
/// Errors: throws Error for a field, robot, log or device that cannot be used.
int replay(const ReplayOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
