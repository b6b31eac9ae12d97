// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The simulated hand: goes where it means to, as smoothly as measured hands do, and stops by feel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/operator.h"

namespace vicinity {
namespace {

constexpr double period_s = 0.001;

Intent straight() {
  Intent intent;
  intent.path_W = {Vec3::Zero(), Vec3(0, 0.3, 0)};
  intent.speed = 0.25;
  return intent;
}

OperatorParameters perfect() {
  OperatorParameters person;
  person.noise = person.depth_error_m = person.across_error_m = 0;
  return person;
}

struct Motion {
  Vec3 end = Vec3::Zero();
  double fastest = 0, time_s = 0;
};

// Hand alone, against a resistance that may depend on where it is.
template <class Resistance>
Motion move(Operator& hand, const Resistance& resistance) {
  Vec3 x = Vec3::Zero(), v = Vec3::Zero();
  Motion motion;
  for (int k = 0; k < 20000 && !hand.done(); ++k) {
    motion.time_s = k * period_s;
    Senses senses{x, v, -resistance(x) * v, 0, x};
    const Vec3 force = hand.act(motion.time_s, period_s, senses);
    v += period_s / 1.5 * (force + senses.felt);
    x += period_s * v;
    motion.fastest = std::max(motion.fastest, v.norm());
  }
  motion.end = x;
  return motion;
}

TEST(Operator, WithoutErrorsEndsAtTheGoalWithTheProfileOfLeastJerk) {
  Operator hand(perfect(), straight(), {}, 1);
  const Motion motion = move(hand, [](const Vec3&) { return 0.0; });
  EXPECT_LT((motion.end - Vec3(0, 0.3, 0)).norm(), 0.006);
  // Flash & Hogan: the peak of a least-jerk motion is 1.875 times its mean.
  EXPECT_NEAR(motion.fastest, 1.875 * 0.25, 0.03);
}

TEST(Operator, ErrsInDepthAsStated) {
  double squares = 0;
  constexpr int people = 300;
  for (int n = 0; n < people; ++n) {
    Operator hand(OperatorParameters{}, straight(), {}, static_cast<std::uint64_t>(n) + 1);
    const double off = move(hand, [](const Vec3&) { return 0.0; }).end.y() - 0.3;
    squares += off * off;
  }
  const double spread = std::sqrt(squares / people);
  EXPECT_NEAR(spread, OperatorParameters{}.depth_error_m, 0.004);
}

TEST(Operator, StopsWhereItFeelsAsInTraining) {
  Intent intent = straight();
  intent.stops_by_feel = true;
  const auto wall = [](const Vec3& x) { return x.y() > 0.2 ? 30.0 : 0.0; };
  Operator hand(perfect(), intent, {Cue::viscosity, 20}, 3);
  EXPECT_LT(move(hand, wall).end.y(), 0.28);
  Operator blind(perfect(), intent, {}, 3);
  EXPECT_GT(move(blind, wall).end.y(), 0.29);
}

TEST(Operator, DoesNotNoticeWhatIsBelowTheWeberFraction) {
  const auto slight = [](const Vec3& x) { return x.y() > 0.1 ? 0.4 : 0.0; };  // 13 % of its own 3
  const auto clear = [](const Vec3& x) { return x.y() > 0.1 ? 12.0 : 0.0; };
  const auto time = [&](const auto& resistance) {
    Operator hand(perfect(), straight(), {Cue::viscosity, 0}, 1);
    return move(hand, resistance).time_s;
  };
  const double free = time([](const Vec3&) { return 0.0; });
  EXPECT_NEAR(time(slight), free, 0.05);
  EXPECT_GT(time(clear), free + 0.2);
}

}  // namespace
}  // namespace vicinity
