// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The hand between pointer and arm: on a slide, where its motion is known in closed form.

#include "live/hand.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cli/small_arm.h"
#include "probe.h"
#include "vicinity/robot/urdf_file.h"

namespace vicinity::viewer {
namespace {

constexpr double period_s = 0.001;

Workspace room() {
  return {.origin = Vec3(-1, -1, -1), .voxel_size = 0.01, .dims = {200, 200, 200}};
}

// The probe, pulled along x, in a drag of so many N·s/m.
struct Slide {
  explicit Slide(double drag, const HandOptions& options = {})
      : robot(probe_robot(room())),
        kinematics(robot),
        hand(robot, 3, AxisVector::Zero(3), options),
        drag_(drag) {
    kinematics.update(hand.q().data(), hand.qd().data(), Pose::Identity());
  }
  void move(const Drive& drive) {
    const AxisVector torque = -drag_ * hand.qd();
    hand.move(drive, kinematics, torque, period_s);
    kinematics.update(hand.q().data(), hand.qd().data(), Pose::Identity());
  }
  RobotModel robot;
  ForwardKinematics kinematics;
  Hand hand;
  double drag_;
};

Drive pulled_to(double x) {
  Drive drive;
  drive.mode = DriveMode::tool;
  drive.p_WT = Vec3(x, 0, 0);
  drive.q = AxisVector::Zero(3);
  return drive;
}

// How far behind a pointer that moves evenly.
double lag_behind(double speed, double drag) {
  Slide slide(drag);
  double x = 0;
  for (int k = 0; k < 1500; ++k) {
    x = speed * period_s * k;
    slide.move(pulled_to(x));
  }
  return x - slide.hand.q()[0];
}

TEST(Hand, StaysBehindThePointerInProportionToDampingAndDrag) {
  const HandOptions options;
  const double damping = 2 * std::sqrt(options.stiffness * options.mass);
  for (const double speed : {0.1, 0.3}) {
    for (const double drag : {0.0, 10.0, 50.0}) {
      // In even motion the spring's pull is what damping and drag take. The least squares give up a
      // little: a few percent.
      const double expected = speed * (damping + drag) / options.stiffness;
      EXPECT_NEAR(lag_behind(speed, drag), expected, 0.12 * expected)
          << speed << " m/s, " << drag << " N·s/m";
    }
  }
}

TEST(Hand, ComesToThePointerWithoutPassingIt) {
  for (const double drag : {0.0, 5.0, 100.0, 1e5}) {
    Slide slide(drag);
    double farthest = 0;
    for (int k = 0; k < 20'000; ++k) {
      slide.move(pulled_to(0.2));
      farthest = std::max(farthest, slide.hand.q()[0]);
      ASSERT_TRUE(std::isfinite(farthest));
      ASSERT_GE(slide.hand.qd()[0], -1e-6) << "drag turned the motion round at " << drag;
    }
    EXPECT_LE(farthest, 0.2 + 1e-4) << drag;
    if (drag <= 100) {
      EXPECT_NEAR(farthest, 0.2, 1e-3) << drag;
    }
  }
}

TEST(Hand, FeelsTheDragThatTheArmFeels) {
  Slide slide(20);
  for (int k = 0; k < 1500; ++k) slide.move(pulled_to(0.2 * period_s * k));
  // 20 N·s/m at 0.2 m/s.
  EXPECT_NEAR(slide.hand.felt(), 4, 0.3);
}

// The small arm, whose joints have limits, at rest at zero; in no drag.
struct SmallArm {
  SmallArm() { kinematics.update(none.data(), none.data(), Pose::Identity()); }
  void move(const Drive& drive) {
    hand.move(drive, kinematics, none, period_s);
    kinematics.update(hand.q().data(), hand.qd().data(), Pose::Identity());
  }
  const AxisVector none = AxisVector::Zero(3);
  RobotModel robot = parse_urdf(cli_test::small_arm, "arm.urdf").robot;
  ForwardKinematics kinematics{robot};
  Hand hand{robot, 3, none};
};

TEST(Hand, IsOnARecordingThatGoesBeyondALimitAsFarAsTheLimit) {
  SmallArm arm;
  const Hand& hand = arm.hand;
  Drive drive;
  drive.mode = DriveMode::follow;
  drive.q = Vec3(0.1, 2.5, 0.3);  // bend goes to 2, slide to 0.1
  for (int k = 0; k < 3000; ++k) arm.move(drive);
  EXPECT_LE((hand.q() - Vec3(0.1, 2, 0.1)).norm(), 1e-12);
  EXPECT_LE(hand.lag(), 1e-12);
  // What no number says moves nothing, and what comes then moves it again.
  drive.q = Vec3(1e306, 0, 0);
  arm.move(drive);
  EXPECT_TRUE(hand.q().allFinite() && hand.qd().allFinite());
  drive.q = Vec3::Zero();
  for (int k = 0; k < 3000; ++k) arm.move(drive);
  EXPECT_LE(hand.q().norm(), 1e-12);
}

TEST(Hand, NeverMovesAJointFasterOrFartherThanItsLimits) {
  SmallArm arm;
  const Hand& hand = arm.hand;
  const double fastest[] = {1.5, 3, 1};  // turn states none
  for (int k = 0; k < 6000; ++k) {
    Drive drive;
    drive.q = AxisVector::Constant(3, k % 2000 < 1000 ? 1e9 : -1e9);
    drive.p_WT = Vec3(k % 700 < 350 ? 1e6 : -1e6, 3, -1e9);
    drive.mode = k < 3000 ? DriveMode::joints : DriveMode::tool;
    const AxisVector before = hand.q();
    arm.move(drive);
    for (int c = 0; c < 3; ++c) {
      ASSERT_LE(std::abs(hand.qd()[c]), fastest[c] * (1 + 1e-9)) << "joint " << c << " at " << k;
      ASSERT_NEAR(hand.q()[c] - before[c], hand.qd()[c] * period_s, 1e-12);
    }
    ASSERT_LE(std::abs(hand.q()[1]), 2 + 1e-12);
    ASSERT_LE(std::abs(hand.q()[2]), 0.1 + 1e-12);
  }
}

}  // namespace
}  // namespace vicinity::viewer
