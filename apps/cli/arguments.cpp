// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vicinity::cli {

std::vector<double> numbers_from(std::string_view option, const std::string& text,
                                 std::size_t count) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  bool good = !text.empty();
  while (good) {
    at += at != end && *at == '+';
    double number = 0;
    const auto [rest, error] = std::from_chars(at, end, number);
    good = error == std::errc() && std::isfinite(number);
    numbers.push_back(number);
    at = rest;
    if (at == end) break;
    good = good && *at++ == ',';
  }
  if (!good || (count != 0 && numbers.size() != count)) {
    throw Error({.where = std::string(option),
                 .what = "is not a list of numbers with commas between them",
                 .found = "'" + text + "'",
                 .expected = count == 0 ? "numbers such as 32,25,20"
                                        : std::to_string(count) + " numbers such as 0.1,0,-0.25"});
  }
  return numbers;
}

Vec3 point_from(std::string_view option, const std::string& text) {
  const auto n = numbers_from(option, text, 3);
  return {n[0], n[1], n[2]};
}

Box box_from(std::string_view option, const std::string& text) {
  const auto n = numbers_from(option, text, 6);
  const Vec3 a(n[0], n[1], n[2]), b(n[3], n[4], n[5]);
  if ((a - b).cwiseAbs().minCoeff() == 0) {
    throw Error({.where = std::string(option),
                 .what = "is a box without volume",
                 .found = "'" + text + "'",
                 .expected = "two opposite corners, x,y,z,x,y,z in metres"});
  }
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

std::vector<std::string> words_from(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

Pose pose_from(std::string_view option, const std::string& text) {
  const auto n = numbers_from(option, text, 6);
  return pose_from_rpy({n[0], n[1], n[2]}, {n[3], n[4], n[5]});
}

LengthUnit unit_from(std::string_view option, const std::string& text) {
  if (const auto unit = length_unit(text)) return *unit;
  throw Error({.where = std::string(option),
               .what = "is not a unit of length",
               .found = "'" + text + "'",
               .expected = "mm, cm, m or in"});
}

}  // namespace vicinity::cli
