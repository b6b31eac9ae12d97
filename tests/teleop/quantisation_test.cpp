// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "rounds.h"
#include "vicinity/teleop/limiter.h"
#include "vicinity/teleop/passivity.h"

namespace vicinity {
namespace {

constexpr double sample_period = 0.001, encoder_step = 1e-4, dry_friction = 0.05;

// A mass with dry friction and no viscous damping at all, behind an encoder: integrated exactly,
// from stop to stop, under a force held for one period.
class DryMass {
 public:
  DryMass(double mass, double position, double velocity)
      : mass_(mass), position_(position), velocity_(velocity) {}

  void hold(double force) {
    double left = sample_period;
    while (left > 0) {
      if (velocity_ == 0 && std::abs(force) <= dry_friction) return;
      const double direction =
          velocity_ != 0 ? std::copysign(1, velocity_) : std::copysign(1, force);
      const double acceleration = (force - direction * dry_friction) / mass_;
      const double stops_in = velocity_ * acceleration < 0 ? -velocity_ / acceleration : left;
      const double step = std::min(stops_in, left);
      position_ += velocity_ * step + acceleration * step * step / 2;
      velocity_ =
          stops_in <= left && velocity_ * acceleration < 0 ? 0 : velocity_ + acceleration * step;
      left -= step;
    }
  }

  double encoder() const { return std::floor(position_ / encoder_step) * encoder_step; }
  double speed() const { return std::abs(velocity_); }

 private:
  double mass_, position_, velocity_;
};

// Whether it still moves after a second, in one of many pushes. `drag` is asked for the B of a
// tick.
template <class Drag>
int still_moving(double mass, int window, const Drag& drag) {
  int moving = 0;
  for (int seed = 0; seed < test::rounds(1000); ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> place(0, encoder_step), push(-0.1, 0.1);
    DryMass joint(mass, place(random), push(random));
    std::deque<double> readings(static_cast<std::size_t>(window) + 1, joint.encoder());
    double fastest_at_last = 0;
    for (int k = 0; k < 1000; ++k) {
      readings.push_back(joint.encoder());
      readings.pop_front();
      const double velocity = (readings.back() - readings.front()) / (window * sample_period);
      joint.hold(-drag(velocity) * velocity);
      if (k >= 900) fastest_at_last = std::max(fastest_at_last, joint.speed());
    }
    moving += fastest_at_last > 0 ? 1 : 0;
  }
  return moving;
}

// Heavy enough that the drag alone would bring it to rest, friction or not (rule 6, with the
// window's delay); and light enough that one step's force moves it visibly.
double mass_for(int window) {
  const double most = 2 * quantisation_limit(dry_friction, window * sample_period, encoder_step);
  return 2 * most * sample_period / mass_limit(window - 1);
}

// Test F of the stability rules.
TEST(Quantisation, NoLimitCycleAtTheBoundAndOneAtTwiceIt) {
  for (const int window : {1, 2, 4}) {
    SCOPED_TRACE("M = " + std::to_string(window));
    const double bound = quantisation_limit(dry_friction, window * sample_period, encoder_step);
    const double mass = mass_for(window);
    EXPECT_EQ(still_moving(mass, window, [&](double) { return bound; }), 0);
    EXPECT_GT(still_moving(mass, window, [&](double) { return 1.2 * bound; }), 0);
    EXPECT_GT(still_moving(mass, window, [&](double) { return 2 * bound; }), 0);
  }
}

TEST(Quantisation, TheLimiterKeepsAnyDragFromBuzzing) {
  for (const int window : {1, 2, 4}) {
    SCOPED_TRACE("M = " + std::to_string(window));
    LimiterOptions options;
    options.mode = LimiterMode::device;
    options.axes = AxisKind::joints;
    options.damping = Eigen::MatrixXd::Constant(1, 1, 1e6);
    options.encoder_step = Eigen::VectorXd::Constant(1, encoder_step);
    options.dry_friction = Eigen::VectorXd::Constant(1, dry_friction);
    DragLimiter limiter(options);
    const Eigen::MatrixXd asked = Eigen::MatrixXd::Constant(
        1, 1, 7 * quantisation_limit(dry_friction, window * sample_period, encoder_step));
    const auto drag = [&](double velocity) {
      const Eigen::VectorXd v = Eigen::VectorXd::Constant(1, velocity);
      const LimiterOutput output = limiter.limit(asked, v, {.window_s = window * sample_period});
      EXPECT_EQ(output.limit, DragLimit::quantisation);
      return output.scale * asked(0, 0);
    };
    EXPECT_EQ(still_moving(mass_for(window), window, drag), 0);
  }
}

}  // namespace
}  // namespace vicinity
