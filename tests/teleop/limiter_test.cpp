// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/limiter.h"
#include "teleop/one_axis.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <random>

#include "no_allocation.h"
#include "rounds.h"
#include "vicinity/geometry/error.h"
#include "vicinity/teleop/energy_audit.h"
#include "vicinity/teleop/passivity.h"
#include "vicinity/teleop/velocity_estimator.h"

namespace vicinity {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Engine = std::mt19937_64;

double uniform(Engine& random, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(random);
}

Eigen::VectorXd random_vector(Engine& random, Eigen::Index n) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
}

// A drag like that of an arm: a few points, each with its Jacobian, over many orders of magnitude.
Eigen::MatrixXd random_drag(Engine& random, Eigen::Index n) {
  Eigen::MatrixXd drag = Eigen::MatrixXd::Zero(n, n);
  const int points = std::uniform_int_distribution(0, 2 * static_cast<int>(n))(random);
  for (int p = 0; p < points; ++p) {
    const Eigen::VectorXd j = random_vector(random, n);
    drag += std::pow(10, uniform(random, -3, 2)) * j * j.transpose();
  }
  return drag;
}

Eigen::MatrixXd random_definite(Engine& random, Eigen::Index n) {
  Eigen::MatrixXd matrix = 0.05 * Eigen::MatrixXd::Identity(n, n);
  for (int p = 0; p < 3; ++p) {
    const Eigen::VectorXd j = random_vector(random, n);
    matrix += j * j.transpose();
  }
  return matrix;
}

LimiterOptions joints(const Eigen::MatrixXd& damping) {
  LimiterOptions options;
  options.axes = AxisKind::joints;
  options.damping = damping;
  return options;
}

TEST(DragLimiter, RhoIsNeverBelowTheLargestEigenvalueAndHardlyAbove) {
  for (int seed = 0; seed < test::rounds(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Engine random(static_cast<std::uint64_t>(seed));
    const auto n = std::uniform_int_distribution<Eigen::Index>(1, axis_capacity)(random);
    const Eigen::MatrixXd damping =
        seed % 2 == 0 ? random_definite(random, n)
                      : Eigen::MatrixXd(random_vector(random, n).cwiseAbs2().asDiagonal());
    const Eigen::MatrixXd drag = random_drag(random, n);
    DragLimiter limiter(joints(damping));
    const LimiterOutput output = limiter.limit(drag, random_vector(random, n));
    // Another route: the pencil D u = rho B u, by Cholesky and QL.
    const double exact = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(drag, damping)
                             .eigenvalues()
                             .maxCoeff();
    ASSERT_EQ(output.status, LimiterStatus::limited);
    EXPECT_GE(output.rho, exact * (1 - 1e-13 * damping.norm() * damping.inverse().norm()));
    EXPECT_LE(output.rho, exact * (1 + 1e-9) + 1e-300);
  }
}

TEST(DragLimiter, RhoOfPlainDampingIsNeverBelowEigensLargestEigenvalue) {
  for (int seed = 0; seed < test::rounds(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Engine random(static_cast<std::uint64_t>(seed));
    const auto n = std::uniform_int_distribution<Eigen::Index>(1, axis_capacity)(random);
    const Eigen::MatrixXd drag = random_drag(random, n);
    DragLimiter limiter(joints(Eigen::MatrixXd::Identity(n, n)));
    const double exact =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(drag).eigenvalues().maxCoeff();
    EXPECT_GE(limiter.limit(drag, random_vector(random, n)).rho, exact);
  }
}

TEST(DragLimiter, ScaledDragIsNeverAboveTheDampingAndDragBelowItIsLeftAlone) {
  for (int seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Engine random(static_cast<std::uint64_t>(seed));
    const auto n = std::uniform_int_distribution<Eigen::Index>(1, 8)(random);
    const Eigen::MatrixXd damping = random_definite(random, n), drag = random_drag(random, n);
    const Eigen::VectorXd velocity = random_vector(random, n);
    DragLimiter limiter(joints(damping));
    const LimiterOutput output = limiter.limit(drag, velocity);
    const auto slack = [&](double scale) {
      return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(damping - scale * drag)
          .eigenvalues()
          .minCoeff();
    };
    EXPECT_GE(slack(output.scale), -1e-9);
    EXPECT_EQ(output.scale < 1, slack(1) < 0);
    EXPECT_TRUE(AxisVector(-output.scale * drag * velocity).isApprox(output.torque, 1e-12) ||
                drag.isZero(0));
    EXPECT_EQ(output.limit, output.scale < 1 ? DragLimit::damping : DragLimit::none);
  }
}

TEST(DragLimiter, TorqueNeverPushesAndNormsStayWithinTheirLimits) {
  for (int seed = 0; seed < test::rounds(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Engine random(static_cast<std::uint64_t>(seed));
    const bool cartesian = seed % 2 == 0;
    const auto n = cartesian ? 3 : std::uniform_int_distribution<Eigen::Index>(1, 8)(random);
    LimiterOptions options = joints(1e3 * random_definite(random, n));
    options.mode = LimiterMode::device;
    options.axes = cartesian ? AxisKind::cartesian : AxisKind::joints;
    options.force_limit = uniform(random, 0.1, 5);
    options.torque_limits =
        random_vector(random, n).cwiseAbs2() + Eigen::VectorXd::Constant(n, 0.01);
    options.ramp_s = 0.002;
    DragLimiter limiter(options);
    for (int k = 0; k < 10; ++k) {
      const Eigen::MatrixXd drag = random_drag(random, n);
      const Eigen::VectorXd velocity = random_vector(random, n);
      const double handle_force = uniform(random, 0, 20);
      const LimiterOutput output =
          limiter.limit(drag, velocity, {.deadline_missed = k == 5, .handle_force = handle_force});
      EXPECT_LE(output.torque.dot(velocity), 0);
      EXPECT_GE(output.power_given, 0);
      EXPECT_LE(output.power_given, output.power_asked * (1 + 1e-12));
      EXPECT_LE((output.torque.cwiseAbs() - options.torque_limits).maxCoeff(), 1e-12);
      EXPECT_LE(output.given, output.asked * (1 + 1e-12));
      const double force = cartesian ? output.torque.norm() : output.scale * handle_force;
      EXPECT_LE(force, *options.force_limit * (1 + 1e-12));
    }
  }
}

TEST(DragLimiter, EachLimitIsNamedWhereItBinds) {
  LimiterOptions options = joints(scalar(5));
  options.axes = AxisKind::joints;
  options.period_s = 0.001;
  options.mass = scalar(0.001);
  options.encoder_step = Eigen::VectorXd::Constant(1, 1e-4);
  options.dry_friction = Eigen::VectorXd::Constant(1, 0.1);
  options.force_limit = 2;
  options.torque_limits = Eigen::VectorXd::Constant(1, 3);
  const Eigen::VectorXd slow = Eigen::VectorXd::Constant(1, 1e-3), fast = slow * 1e4;
  const auto limit = [](const LimiterOptions& o, double drag, const Eigen::VectorXd& velocity,
                        const LimiterTick& tick = {}) {
    return DragLimiter(o).limit(scalar(drag), velocity, tick);
  };
  EXPECT_EQ(limit(options, 0.1, slow).limit, DragLimit::none);
  // Rule 7: f_c T/Delta = 1; a longer window bears more.
  EXPECT_EQ(limit(options, 4, slow).limit, DragLimit::quantisation);
  EXPECT_NEAR(limit(options, 4, slow).scale, 0.25, 1e-12);
  EXPECT_EQ(limit(options, 1.9, slow, {.window_s = 0.004}).limit, DragLimit::none);
  options.encoder_step.resize(0);
  options.dry_friction.resize(0);
  // Rule 6: 2 m/T = 2.
  EXPECT_EQ(limit(options, 4, slow).limit, DragLimit::mass);
  EXPECT_NEAR(limit(options, 4, slow).scale, 0.5, 1e-9);
  options.delay = 1;
  EXPECT_NEAR(limit(options, 4, slow).scale, 0.5 * std::tan(std::acos(-1) / 8), 1e-9);
  options.mass.resize(0, 0);
  EXPECT_EQ(limit(options, 4, slow).limit, DragLimit::none);
  // Rule 2.
  EXPECT_EQ(limit(options, 10, slow).limit, DragLimit::damping);
  EXPECT_NEAR(limit(options, 10, slow).scale, 0.5, 1e-9);
  EXPECT_EQ(limit(options, 4, fast).limit, DragLimit::torque);
  EXPECT_NEAR(limit(options, 4, fast).given, 3, 1e-12);
  EXPECT_EQ(limit(options, 4, fast, {.handle_force = 40}).limit, DragLimit::force);
}

TEST(DragLimiter, DeviceModeTakesTheCeilingAsItIs) {
  LimiterOptions options = joints(scalar(4));
  options.longest_window = 16;
  const Eigen::VectorXd velocity = Eigen::VectorXd::Ones(1);
  const LimiterTick early{.spacing_s = options.period_s / 4, .window_s = options.period_s};
  const LimiterOutput strict = DragLimiter(options).limit(scalar(8), velocity, early);
  EXPECT_NEAR(strict.scale, window_factor(16) / 4 / 2, 1e-9);
  options.mode = LimiterMode::device;
  EXPECT_NEAR(DragLimiter(options).limit(scalar(8), velocity, early).scale, 0.5, 1e-9);
}

TEST(DragLimiter, AMissedDeadlineDropsTheForceAndARampBringsItBackEvenly) {
  LimiterOptions options = joints(scalar(1));
  options.ramp_s = 0.05;
  DragLimiter limiter(options);
  const Eigen::MatrixXd drag = scalar(0.7);
  const Eigen::VectorXd velocity = Eigen::VectorXd::Ones(1);
  EXPECT_EQ(limiter.limit(drag, velocity).scale, 1);  // no ramp where nothing was dropped
  const LimiterOutput missed = limiter.limit(drag, velocity, {.deadline_missed = true});
  EXPECT_EQ(missed.status, LimiterStatus::deadline_missed);
  EXPECT_EQ(missed.torque[0], 0);
  EXPECT_EQ(missed.scale, 0);
  EXPECT_DOUBLE_EQ(missed.asked, 0.7);  // what it cost is said
  double last = 0;
  for (int k = 1; k <= 60; ++k) {
    const LimiterOutput output = limiter.limit(drag, velocity);
    EXPECT_NEAR(output.ramp, std::min(1.0, k / 50.0), 1e-12);
    EXPECT_GE(output.given, last);
    EXPECT_LE(output.given - last, 0.7 / 50 + 1e-12);
    last = output.given;
  }
  EXPECT_DOUBLE_EQ(last, 0.7);
  EXPECT_EQ(limiter.counts().missed_deadlines, 1U);
  EXPECT_EQ(limiter.counts().ticks, 62U);
}

TEST(DragLimiter, TheRampTakesItsTimeHoweverLateATickMayBe) {
  LimiterOptions options = joints(scalar(1));
  options.period_s = 0.05;  // what still counts as on time
  options.ramp_s = 0.1;
  DragLimiter limiter(options);
  const Eigen::VectorXd velocity = Eigen::VectorXd::Ones(1);
  limiter.limit(scalar(0.1), velocity, {.deadline_missed = true});
  for (int k = 1; k <= 120; ++k) {  // ticks that come at 1 kHz
    const LimiterOutput output = limiter.limit(scalar(0.1), velocity, {.spacing_s = 0.001});
    EXPECT_NEAR(output.ramp, std::min(1.0, k / 100.0), 1e-12);
  }
}

TEST(DragLimiter, AStaleVelocityIsUsedForAsLongAsWasPaidFor) {
  LimiterOptions options = joints(scalar(1));
  options.longest_hold = 4;
  DragLimiter limiter(options);
  const Eigen::MatrixXd drag = scalar(10);
  const Eigen::VectorXd velocity = Eigen::VectorXd::Ones(1);
  EXPECT_DOUBLE_EQ(limiter.damping_factor(), 2.0 / 3);
  for (int held = 1; held <= 4; ++held) {
    EXPECT_NEAR(limiter.limit(drag, velocity, {.held = held}).given, 2.0 / 3, 1e-9);
  }
  const LimiterOutput stale = limiter.limit(drag, velocity, {.held = 5});
  EXPECT_EQ(stale.status, LimiterStatus::input_stale);
  EXPECT_EQ(stale.given, 0);
  EXPECT_EQ(limiter.counts().stale, 1U);
  EXPECT_LT(limiter.limit(drag, velocity).ramp, 0.02);
}

TEST(DragLimiter, WhatIsNoDragGivesANamedStatusAndNoForce) {
  Eigen::Matrix2d turning, pushing;
  turning << 1, 0.5, -0.5, 1;
  pushing << 1, 2, 2, 1;  // eigenvalues 3 and -1
  const Eigen::MatrixXd good = Eigen::Matrix2d::Identity();
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(2);
  const auto status = [&](const Eigen::MatrixXd& drag, const Eigen::VectorXd& velocity,
                          const LimiterTick& tick = {}) {
    DragLimiter limiter(joints(Eigen::Matrix2d::Identity()));
    const LimiterOutput output = limiter.limit(drag, velocity, tick);
    EXPECT_TRUE(output.torque.isZero(0));
    EXPECT_EQ(output.torque.size(), 2);
    EXPECT_EQ(limiter.counts().refused, 1U);
    const LimiterOutput next = limiter.limit(good, ones);  // and it recovers
    EXPECT_EQ(next.status, LimiterStatus::limited);
    EXPECT_GT(next.given, 0);
    return output.status;
  };
  EXPECT_EQ(status(turning, ones), LimiterStatus::drag_not_passive);
  EXPECT_EQ(status(pushing, ones), LimiterStatus::drag_not_passive);
  EXPECT_EQ(status(-good, ones), LimiterStatus::drag_not_passive);
  EXPECT_EQ(status(nan * good, ones), LimiterStatus::not_finite);
  EXPECT_EQ(status(infinity * good, ones), LimiterStatus::not_finite);
  EXPECT_EQ(status(good, nan * ones), LimiterStatus::not_finite);
  EXPECT_EQ(status(good, ones, {.spacing_s = nan}), LimiterStatus::not_finite);
  EXPECT_EQ(status(1e300 * good, 1e300 * ones), LimiterStatus::not_finite);
  EXPECT_EQ(status(good, Eigen::VectorXd::Ones(3)), LimiterStatus::wrong_size);
  EXPECT_EQ(status(Eigen::Matrix3d::Identity(), ones), LimiterStatus::wrong_size);
  EXPECT_EQ(status(Eigen::MatrixXd::Identity(20, 20), Eigen::VectorXd::Ones(20)),
            LimiterStatus::wrong_size);
}

TEST(DragLimiter, OptionsThatDoNotFitAreRefused) {
  const LimiterOptions good = joints(Eigen::Matrix2d::Identity());
  const auto refuses = [&](auto spoil) {
    LimiterOptions options = good;
    spoil(options);
    EXPECT_THROW(DragLimiter{options}, Error);
  };
  EXPECT_NO_THROW(DragLimiter{good});
  refuses([](LimiterOptions& o) { o.damping.resize(0, 0); });
  refuses([](LimiterOptions& o) { o.damping.setZero(); });
  refuses([](LimiterOptions& o) { o.damping(0, 1) = 0.5; });
  refuses([](LimiterOptions& o) { o.damping = Eigen::MatrixXd::Identity(17, 17); });
  refuses([](LimiterOptions& o) { o.axes = AxisKind::cartesian; });
  refuses([](LimiterOptions& o) { o.mass = Eigen::Matrix3d::Identity(); });
  refuses([](LimiterOptions& o) { o.encoder_step = Eigen::VectorXd::Ones(2); });
  refuses([](LimiterOptions& o) { o.torque_limits = Eigen::VectorXd::Zero(2); });
  refuses([](LimiterOptions& o) { o.force_limit = -1; });
  refuses([](LimiterOptions& o) { o.period_s = 0; });
  refuses([](LimiterOptions& o) { o.ramp_s = nan; });
  refuses([](LimiterOptions& o) { o.delay = -1; });
  refuses([](LimiterOptions& o) { o.longest_hold = 0; });
  refuses([](LimiterOptions& o) { o.longest_window = 0; });
}

TEST(DragLimiter, TakesNoMemoryAfterConstruction) {
  for (const Eigen::Index n : {1, 3, 7, 16}) {
    Engine random(static_cast<std::uint64_t>(n));
    LimiterOptions options = joints(random_definite(random, n));
    options.mass = random_definite(random, n);
    options.encoder_step = options.dry_friction = Eigen::VectorXd::Ones(n);
    options.torque_limits = Eigen::VectorXd::Ones(n);
    DragLimiter limiter(options);
    EnergyAudit audit(options.damping);
    VelocityEstimator estimator({.noise_band = Eigen::VectorXd::Constant(n, 1e-4)});
    const Eigen::MatrixXd drag = 50 * random_definite(random, n), not_drag = -drag;
    Eigen::VectorXd positions = Eigen::VectorXd::Zero(n);
    double power = 0;
    {
      const NoAllocation guard;
      for (int k = 0; k < 200; ++k) {
        positions.array() += 1e-4 * std::sin(0.1 * k);
        estimator.measure(0.001 * k, positions);
        const LimiterOutput output =
            limiter.limit(k % 17 == 0 ? not_drag : drag, estimator.velocity(),
                          {.deadline_missed = k % 13 == 0, .spacing_s = estimator.spacing_s()});
        audit.record(0.001 * k, positions, output.torque);
        power += output.power_given;
      }
    }
    EXPECT_GT(power, 0);
  }
}

TEST(NoAllocation, SeesWhatEigenTakes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const std::size_t before = allocation_count();
  const Eigen::VectorXd taken = Eigen::VectorXd::Ones(100);
  EXPECT_GT(allocation_count(), before);
  EXPECT_EQ(taken.sum(), 100);
#else
  GTEST_SKIP() << "the sanitizer needs malloc for itself";
#endif
}

// Test E of the stability rules: mu jumps at random in [0, b], in every period or now and then; in
// between the joint goes back and forth against full drag, which is the worst there is. The motion
// is given: where no motion gets energy out, no operator does.
TEST(Passive, AuditNeverGoesNegativeWhereDragJumpsWithinTheDamping) {
  for (const int periods_a_jump : {1, 10, 1000}) {
    SCOPED_TRACE("a jump in " + std::to_string(periods_a_jump) + " periods");
    const double damping = 0.6, period = 0.001;
    Engine random(5);
    EnergyAudit audit(scalar(damping)), too_high(scalar(damping));
    double x = 0, velocity = 1, drag = 0;
    for (int k = 0; k < test::rounds(1'000'000); ++k) {
      const Eigen::VectorXd position = Eigen::VectorXd::Constant(1, x);
      const Eigen::VectorXd force = Eigen::VectorXd::Constant(1, k == 0 ? 0 : -drag * velocity);
      const Eigen::VectorXd more = 1.05 * force;
      audit.record(period * k, position, force);
      too_high.record(period * k, position, more);
      const bool jump = std::uniform_int_distribution(1, periods_a_jump)(random) == 1;
      drag = jump ? uniform(random, 0, damping) : damping;
      velocity = jump ? uniform(random, -1, 1) : -velocity;
      x += period * velocity;
    }
    EXPECT_TRUE(audit.balance().passive);
    EXPECT_GE(audit.balance().lowest, 0);
    EXPECT_EQ(audit.balance().records, test::rounds(1'000'000U) - 1);
    // Drag 5 % above the damping: the test can tell, given time between the jumps.
    if (periods_a_jump == 1000) {
      EXPECT_FALSE(too_high.balance().passive);
    }
  }
}

// An arm, a field and an operator at random; periods of uneven length, none longer than T. With
// `estimated`, the limiter gets the velocity of the estimator, whose windows vary.
void expect_passive(int seed, bool estimated) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  Engine random(static_cast<std::uint64_t>(seed));
  const auto n = std::uniform_int_distribution<Eigen::Index>(1, 7)(random);
  const Eigen::MatrixXd damping =
      estimated ? Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n)) : random_definite(random, n);
  LimiterOptions options = joints(damping);
  options.ramp_s = 0.005;
  options.torque_limits = Eigen::VectorXd::Constant(n, uniform(random, 0.5, 50));
  if (estimated) options.longest_window = 16;
  DragLimiter limiter(options);
  EnergyAudit audit(damping);
  VelocityEstimator estimator({.noise_band = Eigen::VectorXd::Constant(n, 1e-3)});
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n), moved = Eigen::VectorXd::Zero(n);
  double t = 0, elapsed = options.period_s;
  for (int k = 0; k < 2000; ++k) {
    ASSERT_NE(estimator.measure(t, x), VelocityStatus::gap);
    const Eigen::VectorXd velocity =
        estimated ? Eigen::VectorXd(estimator.velocity()) : Eigen::VectorXd(moved / elapsed);
    LimiterTick tick{.deadline_missed = k % 97 == 96, .spacing_s = elapsed};
    if (estimated) tick.spacing_s = estimator.spacing_s(), tick.window_s = 1;
    const LimiterOutput output = limiter.limit(random_drag(random, n), velocity, tick);
    ASSERT_LE(output.torque.dot(velocity), 0);
    audit.record(t, x, output.torque);
    // Next, mostly, the motion that gains most from the force that is held.
    const Eigen::VectorXd next =
        k % 10 == 0
            ? random_vector(random, n)
            : Eigen::VectorXd(uniform(random, 0.5, 1) * damping.ldlt().solve(output.torque));
    elapsed = options.period_s * (k % 3 == 0 ? 1 : uniform(random, 0.25, 1));
    moved = elapsed * next;
    x += moved;
    t += elapsed;
  }
  EXPECT_TRUE(audit.balance().passive) << audit.balance().lowest;
  EXPECT_EQ(audit.balance().unaccounted, 0U);
}

TEST(Passive, StrictLimiterKeepsAnyArmAndAnyFieldPassive) {
  for (int seed = 0; seed < test::rounds(40); ++seed) expect_passive(seed, false);
}

TEST(Passive, StrictLimiterKeepsEstimatedVelocitiesPassive) {
  for (int seed = 0; seed < test::rounds(40); ++seed) expect_passive(seed, true);
}

TEST(Passive, AForceMadeInAShortPeriodIsScaledForTheLongOneItMayActIn) {
  // Short, long, short, long; back and forth so that each displacement feeds most.
  for (const bool told : {true, false}) {
    const double damping = 0.5, period = 0.001;
    DragLimiter limiter(joints(scalar(damping)));
    EnergyAudit audit(scalar(damping));
    const double drag = damping;
    double x = 0, t = 0, velocity = 0, elapsed = period;
    for (int k = 0; k < 1000; ++k) {
      const LimiterOutput output = limiter.limit(
          scalar(drag), Eigen::VectorXd::Constant(1, velocity), {.spacing_s = told ? elapsed : 0});
      audit.record(t, Eigen::VectorXd::Constant(1, x), output.torque);
      elapsed = k % 2 == 0 ? 0.2 * period : period;
      // sqrt(dt) v of equal size and alternating sign.
      velocity = (k % 2 == 0 ? 1 : -1) * std::sqrt(period / elapsed);
      x += velocity * elapsed;
      t += elapsed;
    }
    EXPECT_EQ(audit.balance().passive, told);
  }
}

}  // namespace
}  // namespace vicinity
