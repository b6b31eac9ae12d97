// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The one-joint master, and the verdict on force field against drag.

#include <gtest/gtest.h>

#include <cmath>

#include "bench_room.h"
#include "reproduce/master.h"
#include "reproduce/parts.h"

namespace vicinity::report {
namespace {

// Free of any computer, the hand is a damped oscillator: its motion is known in closed form.
TEST(OneJoint, LeftAloneMovesAsADampedOscillator) {
  const JointSetting setting;
  const auto nothing = [](double, double) { return 0.0; };
  const auto still = [](double) { return 0.0; };
  const double v = 0.2;
  const JointRun run = simulate(setting, nothing, still, 0, v, 2);
  const double decay = (setting.damping + setting.grip_damping) / (2 * setting.mass);
  const double omega = std::sqrt(setting.grip_stiffness / setting.mass - decay * decay);
  for (const JointInstant& instant : run.instants) {
    ASSERT_NEAR(instant.x, v / omega * std::exp(-decay * instant.t) * std::sin(omega * instant.t),
                1e-12)
        << "t = " << instant.t;
  }
  EXPECT_EQ(run.put_in, 0);
}

// What a constant force gives a free-falling joint is what its motion and its dampers have.
TEST(OneJoint, TheBooksOfEnergyBalance) {
  JointSetting setting;
  setting.damping = setting.grip_damping = 0;
  const auto push = [](double, double) { return 1.5; };
  const auto still = [](double) { return 0.0; };
  const JointRun run = simulate(setting, push, still, 0, 0, 0.5);
  const double at_end = 500 * setting.period,
               omega = std::sqrt(setting.grip_stiffness / setting.mass);
  const double x = 1.5 / setting.grip_stiffness * (1 - std::cos(omega * at_end));
  EXPECT_NEAR(run.put_in - run.taken_out, 1.5 * x, 1e-12);
}

class Dynamics : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const BenchRoom room;
    const Layers layers{.m = 1, .q = 6, .shape = LayerShape::cube};
    slot_ = room.workshop().field(slot(), layers);
    post_ = room.workshop().field(post(), layers);
  }
  static ViscosityField slot_, post_;
};
ViscosityField Dynamics::slot_, Dynamics::post_;

TEST_F(Dynamics, VerdictAgreesWithDrag) {
  const DynamicsRuns runs = run_dynamics(slot_, post_, drag_in_one_dimension);
  EXPECT_TRUE(agrees(check_dynamics(runs))) << why(check_dynamics(runs));
}

TEST_F(Dynamics, VerdictTurnsForAForceInPlaceOfDrag) {
  const auto force = [](double mu_S, double) { return 0.2 * mu_S; };
  EXPECT_FALSE(agrees(check_dynamics(run_dynamics(slot_, post_, force))));
}

TEST_F(Dynamics, VerdictTurnsForDragThatPushesAlong) {
  const auto along = [](double mu_S, double v) { return mu_S * v; };
  EXPECT_FALSE(agrees(check_dynamics(run_dynamics(slot_, post_, along))));
}

}  // namespace
}  // namespace vicinity::report
