// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity bridge: joint states in from ROS 2, what they feel out to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "replay/arm.h"

namespace vicinity::bridge {

struct BridgeOptions {
  std::filesystem::path input;  ///< field, or scene (.yaml, .yml); where one is followed, the copy
  cli::ArmOptions arm;
  std::string world = "world";      ///< the frame that the workspace is called
  std::uint32_t domain = 0;         ///< ROS_DOMAIN_ID
  std::string name_space;           ///< "/left": in front of every topic but of transforms
  std::filesystem::path dds;        ///< Cyclone's configuration; empty: this machine alone
  std::string share_field;          ///< under this name, "/cell"; empty: it is not shared
  std::string follow_field;         ///< the one that is shared under this name
  double half_speed_drag = 1;       ///< of the tool: it halves the speed scale [N·s/m]
  std::filesystem::path recording;  ///< .mcap; empty: none; an earlier one is kept
  std::optional<double> seconds;    ///< end by itself
  bool json = false;                ///< the summary, for programs
};

/// Runs until Ctrl-C, or as the options say, and then says what came and what became of it.
/// @return 0
/// Errors: throws Error for a field, robot or DDS domain that cannot be used.
int bridge(const BridgeOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::bridge
