// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/passivity.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

using std::numbers::pi;

int at_least(int lowest, int value, const char* what) {
  if (value >= lowest) return value;
  throw Error({.where = "passivity",
               .what = std::string(what) + " is too small",
               .found = std::to_string(value),
               .expected = std::to_string(lowest) + " or more"});
}

// The highest value of f on [lo, hi], where f has one peak. Each step keeps 0.618 of the interval.
template <class Function>
double peak(const Function& f, double lo, double hi) {
  const double keep = std::numbers::phi - 1;
  double a = hi - keep * (hi - lo), b = lo + keep * (hi - lo);
  double fa = f(a), fb = f(b);
  for (int step = 0; step < 60; ++step) {
    if (fa > fb) {
      hi = b, b = a, fb = fa;
      a = hi - keep * (hi - lo);
      fa = f(a);
    } else {
      lo = a, a = b, fa = fb;
      b = lo + keep * (hi - lo);
      fb = f(b);
    }
  }
  return std::max(fa, fb);
}

}  // namespace

VelocityFilter difference_filter(int samples) {
  at_least(1, samples, "the number of samples");
  return [samples](std::complex<double> z) {
    return (1.0 - std::pow(z, -samples)) / (static_cast<double>(samples) * (1.0 - 1.0 / z));
  };
}

VelocityFilter first_order_filter(double pole) {
  if (!(pole >= 0 && pole < 1)) {
    throw Error({.where = "first-order velocity filter",
                 .what = "the pole does not give a low-pass filter",
                 .found = std::to_string(pole),
                 .expected = "0 <= pole < 1"});
  }
  return [pole](std::complex<double> z) { return (1 - pole) / (1.0 - pole / z); };
}

double needed_damping_ratio(const VelocityFilter& filter, int delay, int variation) {
  at_least(0, delay, "the delay");
  at_least(1, variation, "the variation");
  const auto fed = [&](double theta) {
    return -std::real(std::polar(1.0, -(1 + delay) * theta) * filter(std::polar(1.0, theta)));
  };
  // 32 samples for each turn find the highest peak; its neighbours bracket it.
  const int samples = 32 * (1 + delay + variation);
  const double spacing = pi / samples;
  int highest = 1;
  for (int i = 2; i <= samples; ++i) {
    if (fed(i * spacing) > fed(highest * spacing)) highest = i;
  }
  const double theta = highest * spacing;
  return std::max(fed(theta), peak(fed, theta - spacing / 2 * (highest == 1 ? 1 : 2),
                                   std::min(pi, theta + spacing)));
}

double buzz_frequency(double period_s, int delay) noexcept { return pi / ((1 + delay) * period_s); }

double hold_factor(int longest_hold) {
  return 2 / (1 + std::sqrt(at_least(1, longest_hold, "the longest hold")));
}

double window_factor(int longest_window, int longest_hold) {
  at_least(1, longest_window, "the longest window");
  if (longest_window == 1) return hold_factor(longest_hold);
  double harmonic = 0;
  for (int m = longest_window; m >= 1; --m) harmonic += 1.0 / m;
  return 1 / std::sqrt(harmonic * at_least(1, longest_hold, "the longest hold"));
}

double mass_limit(int delay) {
  return 2 * std::tan(pi / (4 * (1 + at_least(0, delay, "the delay"))));
}

double quantisation_limit(double dry_friction, double window_s, double encoder_step) noexcept {
  return dry_friction * window_s / encoder_step;
}

}  // namespace vicinity
