// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/drag.h"

#include <gtest/gtest.h>

#include <random>

#include "no_allocation.h"
#include "vicinity/viscosity/coding.h"

namespace vicinity {
namespace {

struct RandomMotion {
  explicit RandomMotion(unsigned seed) : random(seed) {}
  Vec3 vector() { return {normal(random), normal(random), normal(random)}; }
  double positive() { return std::exp(3 * normal(random)); }

  std::mt19937 random;
  std::normal_distribution<double> normal;
};

TEST(Drag, IsThePapersProductAlongEachAxis) {
  EXPECT_EQ(drag_force(32, 0.5, {0.25, 0, 0}), Vec3(-4, 0, 0));
  EXPECT_EQ(drag_force(20, 1, {0, -2, 3}), Vec3(0, 40, -60));
}

TEST(Drag, OpposesVelocityAtEveryRank) {
  const Coding coding{{32, 25, 20, 17, 15, 13}, 100};
  const Vec3 v(0.1, -0.2, 0.05);
  double nearer = coding.skin * v.norm();
  for (int rank = 1; rank <= 6; ++rank) {
    const Vec3 force = drag_force(coding.of_rank(rank), 1, v);
    EXPECT_NEAR(force.dot(v), -force.norm() * v.norm(), 1e-12) << "rank " << rank;
    EXPECT_LT(force.norm(), nearer) << "rank " << rank;
    nearer = force.norm();
  }
}

TEST(Drag, IsZeroAtRest) {
  for (const double mu : {0.0, 5.0, 32.0, 100.0}) {
    EXPECT_EQ(drag_force(mu, 1, Vec3::Zero()).norm(), 0);
    EXPECT_EQ(closing_drag_force(mu, 1, Vec3::Zero(), Vec3::UnitX()).norm(), 0);
    EXPECT_EQ(closing_drag_force(mu, 1, Vec3::Zero(), Vec3::Zero()).norm(), 0);
  }
}

TEST(Drag, OnlyTakesEnergyOut) {
  for (unsigned seed = 0; seed < 10'000; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    RandomMotion motion(seed);
    const Vec3 v = motion.vector(), towards = motion.vector().normalized();
    const double mu = motion.positive(), area = motion.positive();
    ASSERT_LE(drag_force(mu, area, v).dot(v), 0);
    ASSERT_LE(closing_drag_force(mu, area, v, towards).dot(v), 0);
  }
}

TEST(ClosingDrag, IsNeverLargerThanAll) {
  for (unsigned seed = 0; seed < 10'000; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    RandomMotion motion(seed);
    const Vec3 v = motion.vector(), towards = motion.vector().normalized();
    const double mu = motion.positive(), area = motion.positive();
    const double all = drag_force(mu, area, v).norm();
    ASSERT_LE(closing_drag_force(mu, area, v, towards).norm(), all * (1 + 1e-15));
    ASSERT_EQ(closing_drag_force(mu, area, v, Vec3::Zero()), drag_force(mu, area, v));
  }
}

TEST(ClosingDrag, OpposesAStraightApproachInFull) {
  const Vec3 v(0, 0, -0.3);
  EXPECT_EQ(closing_drag_force(25, 1, v, {0, 0, -1}), drag_force(25, 1, v));
}

TEST(ClosingDrag, LeavesRetreatAndSlidingFree) {
  EXPECT_EQ(closing_drag_force(25, 1, {0, 0, 0.3}, {0, 0, -1}).norm(), 0);
  EXPECT_EQ(closing_drag_force(25, 1, {0.2, -0.7, 0}, {0, 0, -1}).norm(), 0);
}

TEST(ClosingDrag, OfASlantedMotionIsItsClosingPart) {
  const Vec3 force = closing_drag_force(10, 1, {0.3, 0.4, -0.5}, {0, 0, -1});
  EXPECT_EQ(force, Vec3(0, 0, 5));
}

TEST(Drag, TakesNoMemoryFromTheHeap) {
  const NoAllocation guard;
  EXPECT_GT(drag_force(1, 1, Vec3::Ones()).norm() +
                closing_drag_force(1, 1, Vec3::Ones(), Vec3::UnitZ()).norm(),
            0);
}

}  // namespace
}  // namespace vicinity
