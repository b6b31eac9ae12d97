// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "picture/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vicinity::cli {

std::vector<Tick> ticks_within(double lo, double hi, int wanted) {
  if (!(hi > lo)) return {{lo, fmt::format("{:g}", lo)}};
  const double rough = (hi - lo) / wanted;
  const double power = std::floor(std::log10(rough));
  const double mantissa = rough / std::pow(10, power);
  const double step = (mantissa < 1.5   ? 1
                       : mantissa < 3.5 ? 2
                       : mantissa < 7.5 ? 5
                                        : 10) *
                      std::pow(10, power);
  const int decimals = static_cast<int>(std::max(0.0, -std::floor(std::log10(step) + 1e-9)));
  std::vector<Tick> ticks;
  for (double n = std::ceil(lo / step - 1e-9); n * step <= hi + 1e-9 * step; ++n) {
    const double value = n == 0 ? 0 : n * step;  // no "-0"
    const bool plain = decimals <= 5 && std::abs(value) < 1e6;
    ticks.push_back(
        {value, plain ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:.3g}", value)});
  }
  return ticks;
}

}  // namespace vicinity::cli
