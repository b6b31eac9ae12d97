// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/energy_audit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "teleop/one_axis.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

TEST(EnergySum, KeepsTermsThatPlainSummationLoses) {
  EnergySum sum;
  sum.add(1);
  for (int k = 0; k < 1'000'000; ++k) sum.add(1e-17);
  sum.add(1e20);
  sum.add(-1e20);
  EXPECT_NEAR(sum.value(), 1 + 1e-11, 1e-15);
  EXPECT_NEAR(sum.size(), 2e20, 1e6);
}

TEST(EnergyAudit, AccountsWorkAsForceTimesWayAndDampingAsWaySquaredOverTime) {
  EnergyAudit audit(scalar(0.5));
  EXPECT_EQ(audit.record(10, one(1), one(-3)), AuditStatus::started);
  EXPECT_EQ(audit.record(10.5, one(2), one(4)), AuditStatus::recorded);
  EXPECT_DOUBLE_EQ(audit.balance().drag, 3);            // -(-3)(2 - 1)
  EXPECT_DOUBLE_EQ(audit.balance().device, 0.5 / 0.5);  // b (2 - 1)²/0.5
  EXPECT_EQ(audit.record(11, one(5), one(0)), AuditStatus::recorded);
  EXPECT_DOUBLE_EQ(audit.balance().drag, 3 - 12);
  EXPECT_DOUBLE_EQ(audit.balance().device, 1 + 0.5 * 9 / 0.5);
  EXPECT_DOUBLE_EQ(audit.balance().lowest, 0);
  EXPECT_DOUBLE_EQ(audit.balance().lowest_drag, -9);
  EXPECT_TRUE(audit.balance().passive);
}

TEST(EnergyAudit, SaysWhenTheOperatorGotEnergyOutAndDoesNotForgetIt) {
  EnergyAudit audit(scalar(0.001));
  audit.record(0, one(0), one(1));
  audit.record(1, one(1), one(-1));
  EXPECT_FALSE(audit.balance().passive);
  EXPECT_LT(audit.balance().lowest, -0.9);
  audit.record(2, one(10), one(0));  // paid back tenfold
  EXPECT_GT(audit.balance().drag + audit.balance().device, 0);
  EXPECT_FALSE(audit.balance().passive);
  audit.reset();
  EXPECT_TRUE(audit.balance().passive);
  EXPECT_EQ(audit.balance().records, 0U);
}

// Against the integral itself: a joint with several axes in a held force, its velocity known in
// between. The work is exact; the damping's part is at most what the integral says.
TEST(EnergyAudit, WorkIsThatOfTheIntegralAndDampingNeverMore) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const Eigen::Index n = 4;
  Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
  const Eigen::MatrixXd damping = root * root.transpose();
  EnergyAudit audit(damping);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n), v = x;
  double t = 0, work = 0, eaten = 0;
  for (int k = 0; k < 300; ++k) {
    const Eigen::VectorXd force = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
    audit.record(t, x, force);
    const Eigen::VectorXd pull = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
    const double dt = 0.01 * (1 + std::abs(normal(random)));
    for (int i = 0; i < 100; ++i) {  // constant acceleration: the midpoint rule is exact for x
      const Eigen::VectorXd middle = v + pull * (dt / 200);
      work -= force.dot(middle) * dt / 100;
      eaten += middle.dot(damping * middle) * dt / 100;
      x += middle * (dt / 100);
      v += pull * (dt / 100);
    }
    t += dt;
  }
  audit.record(t, x, Eigen::VectorXd::Zero(n));
  EXPECT_NEAR(audit.balance().drag, work, 1e-9 * std::abs(work));
  EXPECT_LE(audit.balance().device, eaten);
  EXPECT_GT(audit.balance().device, 0.5 * eaten);
}

TEST(EnergyAudit, WhatCannotBeAccountedIsNamedCountedAndSurvived) {
  EnergyAudit audit(scalar(1));
  EXPECT_EQ(audit.record(0, one(0), one(-1)), AuditStatus::started);
  EXPECT_EQ(audit.record(1, one(nan), one(0)), AuditStatus::not_finite);
  EXPECT_EQ(audit.record(2, one(5), one(-1)), AuditStatus::started);
  EXPECT_EQ(audit.record(1, one(6), one(-1)), AuditStatus::time_did_not_advance);
  EXPECT_EQ(audit.record(2, one(6.5), one(-1)), AuditStatus::recorded);
  EXPECT_EQ(audit.record(2, one(6.5), one(-2)), AuditStatus::started);  // same place: new force
  EXPECT_EQ(audit.record(3, one(7), one(nan)), AuditStatus::not_finite);
  EXPECT_EQ(audit.record(4, Eigen::VectorXd::Zero(2), one(0)), AuditStatus::wrong_size);
  EXPECT_EQ(audit.record(std::numeric_limits<double>::infinity(), one(7), one(0)),
            AuditStatus::not_finite);
  EXPECT_EQ(audit.balance().records, 1U);
  EXPECT_EQ(audit.balance().unaccounted, 3U);
  EXPECT_DOUBLE_EQ(audit.balance().drag, 0.5);
}

TEST(EnergyAudit, AWayThatNoNumberHoldsIsNoCredit) {
  EnergyAudit audit(scalar(1));
  EXPECT_EQ(audit.record(0, one(0), one(1)), AuditStatus::started);
  EXPECT_EQ(audit.record(1, one(1e200), one(1)), AuditStatus::not_finite);
  EXPECT_EQ(audit.record(2, one(0), one(0)), AuditStatus::not_finite);
  EXPECT_EQ(audit.balance().unaccounted, 2U);
  EXPECT_EQ(audit.balance().drag, 0);
  EXPECT_EQ(audit.balance().device, 0);
  // A force that feeds the motion is still found.
  EXPECT_EQ(audit.record(3, one(0), one(3)), AuditStatus::recorded);
  EXPECT_EQ(audit.record(4, one(1), one(0)), AuditStatus::recorded);
  EXPECT_DOUBLE_EQ(audit.balance().lowest, -2);
  EXPECT_FALSE(audit.balance().passive);
}

TEST(EnergyAudit, RefusesADampingThatIsNone) {
  EXPECT_NO_THROW(EnergyAudit(Eigen::Matrix2d::Zero()));
  EXPECT_THROW(EnergyAudit(-Eigen::Matrix2d::Identity()), Error);
  EXPECT_THROW(EnergyAudit(Eigen::MatrixXd(2, 3)), Error);
  EXPECT_THROW(EnergyAudit(scalar(nan)), Error);
}

}  // namespace
}  // namespace vicinity
