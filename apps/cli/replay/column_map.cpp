// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/column_map.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "vicinity/geometry/error.h"

namespace vicinity::cli {
namespace {

[[noreturn]] void refuse(std::string_view entry, const char* what) {
  throw Error({.where = "--columns",
               .what = what,
               .found = "'" + std::string(entry) + "'",
               .expected = "entries such as t=Time*0.001,joint_1=Position1"});
}

// "Position1" or "Time*0.001". A star that no number follows belongs to the name.
Column column_from(std::string_view text, std::string_view entry) {
  const std::size_t star = text.rfind('*');
  if (star == std::string_view::npos) return {std::string(text)};
  const std::string_view digits = text.substr(star + 1);
  double factor = 0;
  const auto [rest, error] = std::from_chars(digits.begin(), digits.end(), factor);
  if (error != std::errc() || rest != digits.end()) return {std::string(text)};
  if (!std::isfinite(factor) || factor == 0) refuse(entry, "a factor must be a number, not zero");
  return {std::string(text.substr(0, star)), factor};
}

}  // namespace

ColumnMap column_map_from(const std::string& text) {
  ColumnMap map;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view entry = std::string_view(text).substr(begin, end - begin);
    const std::size_t equals = entry.find('=');
    if (equals == std::string_view::npos) refuse(entry, "an entry has no '='");
    const Column column = column_from(entry.substr(equals + 1), entry);
    if (equals == 0 || column.name.empty()) refuse(entry, "an entry lacks a side");
    if (!map.emplace(entry.substr(0, equals), column).second) {
      refuse(entry, "a quantity has two columns");
    }
    begin = end + 1;
  }
  return map;
}

}  // namespace vicinity::cli
