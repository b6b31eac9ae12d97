// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "shot_view.h"

#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "vicinity/geometry/error.h"

namespace vicinity::viewer {
namespace {

// The text before a separator, which goes with it.
std::string_view next_part(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text = end == text.npos ? std::string_view() : text.substr(end + 1);
  return part;
}

template <class Number>
bool reads(std::string_view text, Number& number) {
  const auto [rest, error] = std::from_chars(text.begin(), text.end(), number);
  return error == std::errc() && rest == text.end();
}

bool one_of(std::string_view value, std::string_view choices) {
  while (!choices.empty()) {
    if (next_part(choices, '|') == value) return true;
  }
  return false;
}

bool is_slice(std::string_view value) {
  if (value == "off") return true;
  const std::string_view axis = next_part(value, ':');
  double metres = 0;
  return one_of(axis, "x|y|z") && reads(value, metres) && std::isfinite(metres);
}

bool are_ranks(std::string_view value) {
  if (value == "all") return true;
  bool good = !value.empty();
  while (good && !value.empty()) {
    int rank = 0;
    good = reads(next_part(value, ','), rank) && rank > 0;
  }
  return good;
}

bool is_understood(std::string_view key, std::string_view value) {
  if (key == "theme") return one_of(value, "dark|light");
  if (key == "view") return one_of(value, "iso|front|side|top");
  if (key == "slice") return is_slice(value);
  if (key == "cut" || key == "panels") return one_of(value, "on|off");
  return key == "shells" && are_ranks(value);
}

}  // namespace

void check_shot_view(std::string_view view) {
  while (!view.empty()) {
    const std::string_view word = next_part(view, '&');
    std::string_view value = word;
    const std::string_view key = next_part(value, '=');
    if (is_understood(key, value)) continue;
    throw Error({.where = "--shot-view",
                 .what = "the page would not understand this",
                 .found = "'" + std::string(word) + "'",
                 .expected = "theme=dark|light, view=iso|front|side|top, slice=y:1.15|off, "
                             "cut=on|off, shells=all|1,6, panels=on|off, with & between them"});
  }
}

}  // namespace vicinity::viewer
