// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Round numbers along an axis.
#pragma once

#include <string>
#include <vector>

namespace vicinity::cli {

struct Tick {
  double value;
  std::string label;
};

/// Multiples of 1, 2 or 5 times a power of ten within [lo, hi], about `wanted` of them, with as
/// many decimals as tell them apart.
std::vector<Tick> ticks_within(double lo, double hi, int wanted);

}  // namespace vicinity::cli
