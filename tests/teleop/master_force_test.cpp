// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/master_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

TEST(MasterForce, IsTheThirdTermOfEquationTen) {
  const MasterArm master{
      .mass = 2, .damping = 3, .gain = 4, .attenuation = 5, .lever = 0.5, .torque_constant = 0.1};
  EXPECT_DOUBLE_EQ(master_force(master, 1.5, 10), 0.1 * (4 * 1.5 + 10.0 / 5) / 0.5);
  EXPECT_DOUBLE_EQ(operator_force(master, 7, 11, 1.5, 10), 2 * 7 + 3 * 11 + 1.6);
}

TEST(MasterForce, WithNothingNearThereIsOnlyTheMasterItself) {
  const MasterArm master{.mass = 2, .damping = 3, .gain = 100};
  EXPECT_EQ(master_force(master, 0, 0), 0);
  EXPECT_EQ(operator_force(master, 1, 1, 0, 0), 5);
}

TEST(MasterForce, AMasterThatCannotBeIsRefused) {
  EXPECT_NO_THROW(checked(MasterArm{}));
  EXPECT_THROW(checked({.lever = 0}), Error);
  EXPECT_THROW(checked({.attenuation = 0}), Error);
  EXPECT_THROW(checked({.gain = -1}), Error);
  EXPECT_THROW(checked({.torque_constant = NAN}), Error);
  EXPECT_THROW(checked({.mass = -1}), Error);
}

}  // namespace
}  // namespace vicinity
