// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Ways to do the same thing, run turn by turn, so that what else the machine does falls on all.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace vicinity::peers {

struct Way {
  std::string name;
  std::function<void()> run;
  int runs = 5;  ///< fewer for a way that takes seconds
};

struct Timing {
  std::string name;
  double wall = 0;  ///< median [s]
  double cpu = 0;   ///< median of user and system time of the whole process [s]
  int runs = 0;
};

/// Runs A B C A B C ... and gives each way's medians, in their order.
std::vector<Timing> side_by_side(const std::vector<Way>& ways);

}  // namespace vicinity::peers
