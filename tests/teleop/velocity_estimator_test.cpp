// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/velocity_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "teleop/one_axis.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

VelocityOptions with_band(double band) { return {.noise_band = one(band)}; }

TEST(VelocityEstimator, EvenMotionIsExactWhateverTheTimesOfTheSamples) {
  for (int seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> step(1e-5, 3e-3);
    VelocityEstimator estimator({.noise_band = Eigen::Vector2d(1e-9, 1e-6)});
    double t = 1e4;
    for (int k = 0; k < 300; ++k) {
      const VelocityStatus status = estimator.measure(t, Eigen::Vector2d(0.3 * t, 5 - 2 * t));
      EXPECT_EQ(status, k == 0 ? VelocityStatus::started : VelocityStatus::measured);
      if (k > 0) {
        // Positions near 2e4 are rounded to 4e-12; over 1e-5 s that is 1e-6 m/s.
        EXPECT_NEAR(estimator.velocity()[0], 0.3, 2e-6);
        EXPECT_NEAR(estimator.velocity()[1], -2, 2e-6);
        EXPECT_LE(estimator.window_s(), std::max(0.004 + 1e-9, 3e-3));
        EXPECT_GE(estimator.window_s(), estimator.spacing_s());
      }
      t += step(random);
    }
  }
}

TEST(VelocityEstimator, FromRestToMotionItLagsByTwoMillisecondsAtMost) {
  for (const double rate_hz : {1000.0, 4000.0}) {
    for (const double speed : {0.001, 0.01, 0.1, 1.0}) {
      for (const double band : {0.0, 1e-6, 1e-4, 1.0}) {
        SCOPED_TRACE(std::to_string(rate_hz) + " Hz, " + std::to_string(speed) + " rad/s, band " +
                     std::to_string(band));
        VelocityEstimator estimator(with_band(band));
        // Lag of a step: the area between the true and the estimated velocity, over the speed.
        double lag_s = 0;
        for (int k = -100; k <= 100; ++k) {
          const double t = k / rate_hz;
          estimator.measure(t, one(speed * std::max(0.0, t)));
          if (k > 0) lag_s += (speed - estimator.velocity()[0]) / speed / rate_hz;
        }
        EXPECT_NEAR(estimator.velocity()[0], speed, 1e-9 * speed);
        EXPECT_GE(lag_s, -1e-9);
        EXPECT_LE(lag_s, 0.002 + 1e-9);
      }
    }
  }
}

TEST(VelocityEstimator, WhereMotionLeavesTheBandTheWindowShortens) {
  VelocityEstimator wide(with_band(1.0)), narrow(with_band(1e-5));
  for (int k = -100; k <= 2; ++k) {
    const double t = k / 4000.0;
    wide.measure(t, one(std::max(0.0, t)));
    narrow.measure(t, one(std::max(0.0, t)));
  }
  EXPECT_NEAR(wide.window_s(), 0.004, 1e-9);
  EXPECT_LE(narrow.window_s(), 3 / 4000.0);
  EXPECT_NEAR(narrow.velocity()[0], 1, 0.05);
  EXPECT_LT(wide.velocity()[0], 0.2);
}

TEST(VelocityEstimator, TheEncodersStepsAreQuieterThanInAPlainDifference) {
  const double step = 1e-4;
  VelocityEstimator plain(with_band(0)), adaptive(with_band(step));
  double plain_error = 0, adaptive_error = 0;
  for (int k = 0; k < 4000; ++k) {
    const double t = k / 4000.0, speed = 0.05;
    const Eigen::VectorXd reading = one(std::floor(speed * t / step) * step);
    plain.measure(t, reading);
    adaptive.measure(t, reading);
    if (k < 100) continue;
    plain_error = std::max(plain_error, std::abs(plain.velocity()[0] - speed));
    adaptive_error = std::max(adaptive_error, std::abs(adaptive.velocity()[0] - speed));
  }
  EXPECT_LE(adaptive_error, step / 0.004 + 1e-9);  // one step in the longest window
  EXPECT_GT(plain_error, 5 * adaptive_error);
}

// The definition, word by word: for each window length all inner samples against the line.
double by_definition(const std::vector<double>& t, const std::vector<double>& x, double longest,
                     double band) {
  double velocity = 0;
  const std::size_t last = t.size() - 1;
  for (std::size_t first = last; first-- > 0;) {
    if (first + 1 != last && t[last] - t[first] > longest) break;
    const double slope = (x[last] - x[first]) / (t[last] - t[first]);
    for (std::size_t i = first + 1; i < last; ++i) {
      if (std::abs(x[i] - (x[last] - slope * (t[last] - t[i]))) > band) return velocity;
    }
    velocity = slope;
  }
  return velocity;
}

TEST(VelocityEstimator, WindowIsTheLongestWhoseSamplesLieInTheBandAroundItsEnds) {
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> step(2e-4, 1e-3);
    const double band = 3e-4;
    VelocityEstimator estimator(with_band(band));
    std::vector<double> t{0}, x{0};
    estimator.measure(0, one(0));
    for (int k = 1; k < 400; ++k) {
      t.push_back(t.back() + step(random));
      x.push_back(0.2 * std::sin(20 * t.back()) + 1e-4 * normal(random));
      estimator.measure(t.back(), one(x.back()));
      EXPECT_NEAR(estimator.velocity()[0], by_definition(t, x, 0.004 * (1 + 1e-9), band), 1e-9);
    }
  }
}

TEST(VelocityEstimator, WhatIsNoNewSampleIsNamedAndLeavesNoForceBehind) {
  VelocityEstimator estimator(with_band(1e-5));
  EXPECT_EQ(estimator.measure(1, one(0)), VelocityStatus::started);
  EXPECT_EQ(estimator.measure(1.001, one(0.001)), VelocityStatus::measured);
  EXPECT_NEAR(estimator.velocity()[0], 1, 1e-9);
  EXPECT_EQ(estimator.measure(1.001, one(0.5)), VelocityStatus::time_stood_still);
  EXPECT_NEAR(estimator.velocity()[0], 1, 1e-9);  // still the latest
  EXPECT_EQ(estimator.measure(1.002, one(nan)), VelocityStatus::not_finite);
  EXPECT_EQ(estimator.velocity()[0], 0);
  EXPECT_EQ(estimator.measure(1.002, Eigen::VectorXd::Zero(2)), VelocityStatus::wrong_size);
  EXPECT_EQ(estimator.velocity()[0], 0);
  EXPECT_EQ(estimator.measure(1.003, one(0.003)), VelocityStatus::measured);  // and goes on
  EXPECT_NEAR(estimator.velocity()[0], 1, 1e-9);
  EXPECT_EQ(estimator.measure(0.5, one(0)), VelocityStatus::time_ran_backwards);
  EXPECT_EQ(estimator.velocity()[0], 0);
  EXPECT_EQ(estimator.window_s(), 0);
  EXPECT_EQ(estimator.measure(0.501, one(0.002)), VelocityStatus::measured);
  EXPECT_NEAR(estimator.velocity()[0], 2, 1e-9);
  EXPECT_EQ(estimator.measure(0.7, one(0)), VelocityStatus::gap);
  EXPECT_EQ(estimator.velocity()[0], 0);
  estimator.restart();
  EXPECT_EQ(estimator.measure(0.2, one(0)), VelocityStatus::started);
}

TEST(VelocityEstimator, OptionsThatMeanNothingAreRefused) {
  EXPECT_THROW(VelocityEstimator{VelocityOptions{}}, Error);
  EXPECT_THROW(VelocityEstimator{with_band(-1)}, Error);
  EXPECT_THROW(VelocityEstimator{with_band(nan)}, Error);
  EXPECT_THROW((VelocityEstimator{{.longest_window_s = 0, .noise_band = one(0)}}), Error);
  EXPECT_THROW((VelocityEstimator{{.noise_band = Eigen::VectorXd::Zero(axis_capacity + 1)}}),
               Error);
}

}  // namespace
}  // namespace vicinity
