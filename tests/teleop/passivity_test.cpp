// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/passivity.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <tuple>
#include <vector>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

double highest_eigenvalue(const Eigen::MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

// What the computer feeds in over many periods, as a quadratic form of the periods' mean
// velocities: feeding[k][j] is the share of v_j in the force that acts in period k. b/B must be at
// least its numerical radius towards minus infinity. All period sequences count: no frequency, no
// filter.
double needed_ratio(const Eigen::MatrixXd& feeding) {
  return highest_eigenvalue(-(feeding + feeding.transpose()) / 2);
}

// Test A of the stability rules.
TEST(Passivity, DampingNeededByADifferenceFilterIsThatOfTheTable) {
  const std::vector<std::tuple<int, std::array<double, 3>>> table = {
      {1, {1, 1, 1}},          {2, {.5625, .817, .903}}, {4, {.380, .605, .737}},
      {8, {.296, .434, .546}}, {15, {.259, .337, .410}}, {20, {.248, .308, .365}},
      {50, {.230, .254, .278}}};
  for (const auto& [samples, row] : table) {
    for (int delay = 0; delay < 3; ++delay) {
      SCOPED_TRACE("M = " + std::to_string(samples) + ", d = " + std::to_string(delay));
      EXPECT_NEAR(needed_damping_ratio(difference_filter(samples), delay, samples),
                  row[static_cast<std::size_t>(delay)], 1e-3);
    }
  }
}

TEST(Passivity, DampingNeededByAFilterIsWhatTheWorstMotionOfManyPeriodsNeeds) {
  for (const int samples : {1, 2, 4, 8}) {
    for (int delay = 0; delay < 3; ++delay) {
      SCOPED_TRACE("M = " + std::to_string(samples) + ", d = " + std::to_string(delay));
      const int periods = 300;
      Eigen::MatrixXd feeding = Eigen::MatrixXd::Zero(periods, periods);
      for (int k = 0; k < periods; ++k) {
        for (int i = 1; i <= samples; ++i) {
          if (k - delay - i >= 0) feeding(k, k - delay - i) = 1.0 / samples;
        }
      }
      EXPECT_NEAR(needed_damping_ratio(difference_filter(samples), delay, samples),
                  needed_ratio(feeding), 2e-3);
    }
  }
}

TEST(Passivity, AFirstOrderFilterWithoutDelayNeedsOneMinusPoleOverOnePlusPole) {
  for (const double pole : {0.0, 0.1, 0.5, 0.9, 0.99}) {
    EXPECT_NEAR(needed_damping_ratio(first_order_filter(pole), 0), (1 - pole) / (1 + pole), 1e-9);
  }
}

TEST(Passivity, WithoutAFilterDragMayBeAsHighAsTheDampingWhateverTheDelay) {
  for (int delay = 0; delay < 6; ++delay) {
    EXPECT_NEAR(needed_damping_ratio(first_order_filter(0), delay), 1, 1e-12);
  }
}

// A joint with damping b, held by a lossless operator, integrated exactly. The operator is a string
// of characteristic impedance Z (it carries the joint's mass as well), clamped at its far end: what
// goes out comes back T(1+d) later. With the joint free that is a resonance at pi/((1+d)T) and at
// all its odd multiples. A single spring and mass would not do: its motion is a sine, the worst
// motion is a zigzag.
//
// All that is held is constant within a period, so that waves are too: one number a period is
// exact.
class JointOnAString {
 public:
  JointOnAString(double damping, double drag, int delay)
      : damping_(damping),
        drag_(drag),
        waves_(static_cast<std::size_t>(1 + delay)),
        velocities_(static_cast<std::size_t>(1 + delay), 0) {
    for (double& wave : waves_) wave = 0.1;
  }

  void step() {
    const double arriving = waves_[at_];
    // F_k = -B v^_{k-d}, and v^_k is the velocity of the period that ends at k.
    const double held = -drag_ * velocities_[at_];
    const double velocity = (held + 2 * arriving) / (damping_ + impedance);
    waves_[at_] = arriving - impedance * velocity;
    velocities_[at_] = velocity;
    fed_ += held * velocity * period;
    eaten_ += damping_ * velocity * velocity * period;
    at_ = (at_ + 1) % waves_.size();
  }

  double energy_of_string() const {
    double energy = 0;
    for (const double wave : waves_) energy += wave * wave * period / impedance;
    return energy;
  }
  double fed_by_computer() const { return fed_; }
  double eaten_by_damping() const { return eaten_; }

 private:
  static constexpr double period = 0.001, impedance = 0.7;
  double damping_, drag_, fed_ = 0, eaten_ = 0;
  std::vector<double> waves_;       // on their way to the far end and back
  std::vector<double> velocities_;  // of the last 1 + d periods
  std::size_t at_ = 0;
};

// Test B of the stability rules.
TEST(Passivity, ATunedLosslessOperatorGetsEnergyOnlyFromDragAboveTheDamping) {
  const double damping = 0.8;
  for (int delay = 0; delay < 4; ++delay) {
    SCOPED_TRACE("d = " + std::to_string(delay));
    JointOnAString below(damping, 0.999 * damping, delay), above(damping, 1.05 * damping, delay);
    const double at_first = below.energy_of_string();
    double highest = 0, lowest_account = 0;
    for (int k = 0; k < 20'000; ++k) {
      below.step();
      if (k < 500 * (1 + delay)) above.step();
      highest = std::max(highest, below.energy_of_string());
      lowest_account = std::min(lowest_account, below.eaten_by_damping() - below.fed_by_computer());
    }
    EXPECT_LE(highest, at_first);
    EXPECT_GE(lowest_account, 0);
    EXPECT_GT(above.energy_of_string(), 10 * at_first);
    EXPECT_LT(above.eaten_by_damping() - above.fed_by_computer(), -at_first);
  }
}

TEST(Passivity, TheBuzzIsAtPiOverOnePlusDPeriods) {
  for (int delay = 0; delay < 4; ++delay) {
    // The frequency at which the plain difference feeds most: -cos((1+d) theta) = 1.
    const double theta = buzz_frequency(0.002, delay) * 0.002;
    EXPECT_NEAR(-std::cos((1 + delay) * theta), 1, 1e-12);
    EXPECT_NEAR(theta, std::numbers::pi / (1 + delay), 1e-12);
  }
}

// A free mass under a held force, exactly: the mean velocity of each period after `periods`.
double speed_left(double drag_per_mass, int delay, int periods) {
  std::vector<double> measured(static_cast<std::size_t>(delay + 1), 1.0);  // v^_{k-d}..v^_k, a ring
  double velocity = 1;
  double largest = 0;
  std::size_t at = 0;
  for (int k = 0; k < periods; ++k) {
    const double change = -drag_per_mass * measured[at];
    measured[at] = velocity + change / 2;
    velocity += change;
    at = (at + 1) % measured.size();
    if (k >= periods - 50) largest = std::max(largest, std::abs(velocity));
  }
  return largest;
}

// Test C of the stability rules.
TEST(Passivity, AFreeMassComesToRestJustBelowTheMassLimitAndNotJustAbove) {
  const std::array<double, 6> stated{2, .828, .536, .398, .317, .263};
  for (int delay = 0; delay < 6; ++delay) {
    SCOPED_TRACE("d = " + std::to_string(delay));
    const double limit = mass_limit(delay);
    EXPECT_NEAR(limit, stated[static_cast<std::size_t>(delay)], 0.0006);
    EXPECT_LT(speed_left(0.995 * limit, delay, 20'000), 1e-3);
    EXPECT_GT(speed_left(1.005 * limit, delay, 20'000), 1e3);
  }
}

TEST(Passivity, TheMassLimitPutsTheFirstRootOntoTheUnitCircle) {
  for (int delay = 0; delay < 10; ++delay) {
    SCOPED_TRACE("d = " + std::to_string(delay));
    // z^{d+2} - z^{d+1} + (g/2)(z + 1) = 0, by the eigenvalues of its companion matrix.
    const Eigen::Index n = delay + 2;
    Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
    companion.bottomLeftCorner(n - 1, n - 1).setIdentity();
    companion(0, 0) = 1;
    companion(0, n - 2) -= mass_limit(delay) / 2;
    companion(0, n - 1) -= mass_limit(delay) / 2;
    EXPECT_NEAR(companion.eigenvalues().cwiseAbs().maxCoeff(), 1, 1e-9);
  }
}

// One force for each entry of `holds`, acting for so many periods; with `zeroing`, for one of them.
// The periods form a ring: the last hold's velocity makes the first hold's force, so that few of
// them stand for a sequence without end.
Eigen::MatrixXd held_force(const std::vector<int>& holds, bool zeroing) {
  int periods = 0;
  for (const int hold : holds) periods += hold;
  Eigen::MatrixXd feeding = Eigen::MatrixXd::Zero(periods, periods);
  int first = 0;
  for (const int hold : holds) {
    const int measured = (first + periods - 1) % periods;
    for (int i = 0; i < (zeroing ? 1 : hold); ++i) feeding(first + i, measured) = 1;
    first += hold;
  }
  return feeding;
}

// Test D of the stability rules.
TEST(Passivity, HoldingNeedsHalfOfOnePlusTheRootOfNAndZeroingNeedsOne) {
  for (int n = 1; n <= 16; ++n) {
    SCOPED_TRACE("N = " + std::to_string(n));
    const std::vector<int> all(8, n);
    EXPECT_NEAR(needed_ratio(held_force(all, false)), (1 + std::sqrt(n)) / 2, 1e-9);
    EXPECT_NEAR(needed_ratio(held_force(all, false)) * hold_factor(n), 1, 1e-9);
  }
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const int n = std::uniform_int_distribution(2, 9)(random);
    std::vector<int> mixed(20);
    for (int& hold : mixed) hold = std::uniform_int_distribution(1, n)(random);
    EXPECT_LE(needed_ratio(held_force(mixed, false)) * hold_factor(n), 1 + 1e-12);
    EXPECT_LE(needed_ratio(held_force(mixed, true)), 1 + 1e-12);
    // 1 is not only enough but needed: the ticks between two misses can be many.
    mixed.insert(mixed.end(), 100, 1);
    EXPECT_GT(needed_ratio(held_force(mixed, true)), 0.999);
  }
}

TEST(Passivity, WindowsThatVaryWithTickAndAxisStayWithinTheWindowFactor) {
  for (int seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const int longest = std::uniform_int_distribution(1, 12)(random);
    const int periods = 80, axes = 2;
    std::uniform_real_distribution<double> angle(0, std::numbers::pi);
    Eigen::MatrixXd feeding = Eigen::MatrixXd::Zero(axes * periods, axes * periods);
    for (int k = 0; k + 1 < periods; ++k) {
      const double a = angle(random);
      const Eigen::Vector2d u(std::cos(a), std::sin(a));
      const Eigen::Matrix2d drag = u * u.transpose();  // an extreme point of 0 <= D <= I
      for (int axis = 0; axis < axes; ++axis) {
        const int window = std::min(std::uniform_int_distribution(1, longest)(random), k + 1);
        for (int i = 0; i < window; ++i) {
          feeding.block<2, 1>(axes * (k + 1), axes * (k - i) + axis) += drag.col(axis) / window;
        }
      }
    }
    EXPECT_LE(needed_ratio(feeding) * window_factor(longest), 1 + 1e-12);
  }
}

TEST(Passivity, AFixedWindowNeedsNoFactorEvenWhereDragJumps) {
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const int window = std::uniform_int_distribution(1, 12)(random);
    Eigen::MatrixXd feeding = Eigen::MatrixXd::Zero(120, 120);
    for (int k = 1; k < 120; ++k) {
      const double drag = std::uniform_int_distribution(0, 1)(random);
      for (int i = 1; i <= std::min(window, k); ++i) feeding(k, k - i) = drag / window;
    }
    EXPECT_LE(needed_ratio(feeding), 1 + 1e-12);
  }
}

TEST(Passivity, ArgumentsThatMeanNothingAreRefused) {
  EXPECT_THROW(difference_filter(0), Error);
  EXPECT_THROW(first_order_filter(1), Error);
  EXPECT_THROW(first_order_filter(NAN), Error);
  EXPECT_THROW(needed_damping_ratio(first_order_filter(0), -1), Error);
  EXPECT_THROW(hold_factor(0), Error);
  EXPECT_THROW(window_factor(0), Error);
  EXPECT_THROW(mass_limit(-1), Error);
}

}  // namespace
}  // namespace vicinity
