// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "demo/arm_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include "fresh_file.h"

namespace vicinity::cli {
namespace {

constexpr std::size_t joints = 7;
constexpr double samples_per_second = 100;

using Joints = std::array<double, joints>;

struct Stop {
  double t;  // [s]
  Joints q;  // [rad]
};

// The tool points level in all but the first: joints 2, 4 and 6 add up to a right angle.
constexpr Joints aside{-0.8, -0.33, 0, 2.416, 0, -0.515, 0};
constexpr Joints before_the_risers{0.08, -0.33, 0, 2.416, 0, -0.515, 0};
constexpr Joints at_the_flange{0.08, 0.1, 0, 2.416, 0, -0.945, 0};
constexpr std::array stops = {
    Stop{0, aside},         Stop{2, before_the_risers},   Stop{3.25, at_the_flange},
    Stop{4, at_the_flange}, Stop{6.5, before_the_risers}, Stop{10.5, aside}};

// From rest to rest, as smoothly as a hand moves: least jerk.
double eased(double s) { return s * s * s * (10 + s * (6 * s - 15)); }

Joints at(double t) {
  const auto next = std::ranges::find_if(stops.begin() + 1, stops.end() - 1,
                                         [&](const Stop& stop) { return t < stop.t; });
  const auto last = std::prev(next);
  const double s = eased(std::clamp((t - last->t) / (next->t - last->t), 0.0, 1.0));
  Joints q{};
  for (std::size_t c = 0; c < joints; ++c) q[c] = last->q[c] + s * (next->q[c] - last->q[c]);
  return q;
}

}  // namespace

void write_arm_motion(const std::filesystem::path& path) {
  std::string text = "t";
  for (std::size_t c = 0; c < joints; ++c) text += fmt::format(",joint_{}", c + 1);
  text += '\n';
  const auto last = std::lround(stops.back().t * samples_per_second);
  for (long n = 0; n <= last; ++n) {
    const double t = static_cast<double>(n) / samples_per_second;
    text += fmt::format("{:g}", t);
    for (const double q : at(t)) text += fmt::format(",{:.9g}", q);
    text += '\n';
  }
  FreshFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace vicinity::cli
