// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity bench tick: what the tick costs on this machine.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

#include "replay/arm.h"

namespace vicinity::cli {

struct BenchTickOptions {
  std::filesystem::path field;  ///< empty: the demo's hot cell and its arm
  ArmOptions arm;               ///< `points` is not used
  std::string points = "100,1000,10000,100000,1000000";
  double seconds = 5;  ///< for each number of points
  bool json = false;
};

/// Sways an arm about in a field, with as many body points as asked for, and times every tick.
/// After each tick an empty loop of the same length runs, which uses no memory: what it is late is
/// the machine's doing and not ours.
/// @return 0
/// Errors: throws Error for options that fit nothing.
int bench_tick(const BenchTickOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
