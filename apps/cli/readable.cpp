// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "readable.h"

#include <fmt/format.h>

#include <array>

namespace vicinity::cli {

std::string grouped(std::uint64_t n) {
  const std::string digits = std::to_string(n);
  std::string text;
  for (std::size_t at = 0; at < digits.size(); ++at) {
    if (at != 0 && (digits.size() - at) % 3 == 0) text += ',';
    text += digits[at];
  }
  return text;
}

std::string bytes(std::uint64_t n) {
  constexpr std::array units = {"kB", "MB", "GB", "TB", "PB", "EB"};
  if (n < 1000) return fmt::format("{} B", n);
  double value = static_cast<double>(n) / 1000;
  std::size_t unit = 0;
  for (; value >= 999.5; ++unit) value /= 1000;
  return fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, units[unit]);
}

std::string seconds(double s) {
  return fmt::format("{:.{}f} s", s, s < 0.1 ? 3 : s < 10 ? 2 : s < 60 ? 1 : 0);
}

}  // namespace vicinity::cli
