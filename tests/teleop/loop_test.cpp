// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The loop without physics: the way there and back, one joint as in eq. (10), and strict under
// everything the way can do to it.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/teleop/loop.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

constexpr double period_s = 0.001;

// One joint that turns about z, its point 0.4 m out.
RobotModel one_joint() {
  return parse_urdf(
             "<robot name=\"arm\"><link name=\"base\"/><link name=\"bar\"/>"
             "<joint name=\"turn\" type=\"continuous\"><parent link=\"base\"/><child link=\"bar\"/>"
             "<axis xyz=\"0 0 1\"/></joint>"
             "<joint name=\"end\" type=\"fixed\"><origin xyz=\"0.4 0 0\"/><parent link=\"bar\"/>"
             "<child link=\"tip\"/></joint><link name=\"tip\"/></robot>",
             "arm.urdf")
      .robot;
}

BodyPoints one_point(const RobotModel& robot, double area) {
  BodyPointOptions options;
  options.points_per_m2 = 0;
  options.named["bar"] = {Vec3(0.4, 0, 0), area};
  return sample_body_points(robot, options);
}

// A wall that the bar's end turns towards, in thick layers.
const ViscosityField& wall() {
  static const ViscosityField field = [] {
    Scene scene;
    scene.voxel_size = 0.01;
    SceneObject object{.name = "wall", .shape = primitive::box({0.4, 0.02, 0.2})};
    object.X_WO.translation() = Vec3(0.4, 0.2, 0);
    object.m = 4;
    object.q = 4;
    scene.objects.push_back(object);
    return build_field(scene).field;
  }();
  return field;
}

AxisVector axis(double value) { return AxisVector::Constant(1, value); }

struct OneJoint {
  explicit OneJoint(const LoopOptions& loop_options, double area = 0.02,
                    std::optional<double> damping = std::nullopt)
      : robot(one_joint()),
        teleoperation(robot, one_point(robot, area), wall(), options(loop_options, damping)),
        aid(teleoperation),
        loop(Lead(robot, AxisKind::joints, -1, Pose::Identity()), aid, loop_options) {}

  static TeleoperationOptions options(const LoopOptions& loop, std::optional<double> damping) {
    TeleoperationOptions tick;
    const int periods = loop.placement == Placement::remote ? loop.slave_periods : 1;
    tick.longest_period_s = 1.5 * periods * period_s;
    if (damping) {
      LimiterOptions limiter;
      limiter.axes = AxisKind::joints;
      limiter.damping = Eigen::MatrixXd::Constant(1, 1, *damping);
      tick.limiter = limiter;
    }
    return tick;
  }

  RobotModel robot;
  Teleoperation teleoperation;
  DragAid aid;
  TeleoperationLoop loop;
};

TEST(Transport, ArrivesOnceWhenItIsDue) {
  Transport<int> way({.delay_s = 0.003}, 1000);
  for (int k = 0; k < 20; ++k) {
    way.send(k * period_s, k);
    const int* const got = way.receive(k * period_s);
    if (k < 3) {
      EXPECT_EQ(got, nullptr);
    } else {
      ASSERT_NE(got, nullptr) << k;
      EXPECT_EQ(*got, k - 3);
    }
    EXPECT_EQ(way.receive(k * period_s), nullptr) << "handed out twice";
  }
}

TEST(Transport, NeverGoesBackInTimeAndLosesItsShare) {
  Transport<int> way({.delay_s = 0.01, .jitter_s = 0.02, .loss = 0.3, .seed = 4}, 1000);
  int last = -1, received = 0;
  for (int k = 0; k < 20000; ++k) {
    way.send(k * period_s, k);
    if (const int* const got = way.receive(k * period_s)) {
      EXPECT_GT(*got, last);
      EXPECT_LE(*got, k - 10);
      EXPECT_GE(*got, k - 60);
      last = *got;
      ++received;
    }
  }
  EXPECT_GT(received, 2000);
  Transport<int> deaf({.loss = 1}, 1000);
  deaf.send(0, 1);
  EXPECT_EQ(deaf.receive(1), nullptr);
}

TEST(Transport, RefusesWhatIsNoWay) {
  EXPECT_THROW(Transport<int>({.delay_s = -1}, 1000), Error);
  EXPECT_THROW(Transport<int>({.jitter_s = NAN}, 1000), Error);
  EXPECT_THROW(Transport<int>({.loss = 1.1}, 1000), Error);
  EXPECT_THROW(Transport<int>({.delay_s = 1e6}, 1000), Error);
}

// Eq. (10): M x'' + B x' + lambda (G tau1 + tau2/A)/L = Fh, term by term.
TEST(Loop, OneJointFeelsTheThirdTermOfEquation10) {
  LoopOptions options;
  options.master = {.gain = 3, .attenuation = 20, .lever = 0.5, .torque_constant = 2};
  constexpr double area = 0.02, speed = 0.5, tau2 = 8;
  OneJoint arm(options, area);
  arm.loop.start(axis(0), axis(0), 0);
  bool felt = false;
  for (int k = 0; k < 900; ++k) {
    const double angle = speed * k * period_s;
    const MasterTick& tick = arm.loop.master(k * period_s, axis(angle));
    arm.loop.slave(k * period_s, axis(tau2));
    if (k < 10) continue;
    // By hand: one point, its viscosity, its speed, its lever.
    const double mu = wall().at({0.4 * std::cos(angle), 0.4 * std::sin(angle), 0}).viscosity;
    const double tau1 = mu * area * 0.4 * speed * 0.4;
    EXPECT_NEAR(-tick.aid[0], 2.0 * 3 / 0.5 * tau1, 1e-6 + 1e-3 * tau1) << k;
    EXPECT_NEAR(-tick.reflected[0], 2.0 * tau2 / 20 / 0.5, 1e-12) << k;
    felt = felt || mu > 0;
  }
  EXPECT_TRUE(felt);
}

TEST(Loop, TheSlaveIsLedADelayLater) {
  LoopOptions options;
  options.there.delay_s = 0.025;
  OneJoint arm(options);
  arm.loop.start(axis(0), axis(0), 0);
  for (int k = 0; k < 200; ++k) {
    arm.loop.master(k * period_s, axis(0.001 * k));
    const AxisVector& led = arm.loop.slave(k * period_s, axis(0));
    EXPECT_NEAR(led[0], 0.001 * std::max(0, k - 25), 1e-12);
  }
}

TEST(Loop, TheEncoderRoundsDown) {
  LoopOptions options;
  options.encoder_step = Eigen::VectorXd::Constant(1, 0.01);
  OneJoint arm(options);
  arm.loop.start(axis(0), axis(0), 0);
  arm.loop.master(0, axis(0.0999));
  EXPECT_NEAR(arm.loop.lead().q()[0], 0.09, 1e-12);
}

// A hand that shakes as it likes, on a way that delays, jitters and loses: the account with the
// device's own damping never falls below zero.
TEST(Loop, StrictGivesNoEnergyWhateverTheWayDoes) {
  constexpr double damping = 0.4;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(0, 1);
  for (int trial = 0; trial < 60; ++trial) {
    LoopOptions options;
    options.placement = trial % 2 == 0 ? Placement::remote : Placement::local;
    options.slave_periods = 1 + trial % 3;
    options.there = {0.1 * any(random), trial % 4 == 0 ? 0.01 * any(random) : 0,
                     trial % 5 == 0 ? 0.3 : 0, static_cast<std::uint64_t>(trial)};
    options.back = options.there;
    options.damping = Eigen::MatrixXd::Constant(1, 1, damping);
    OneJoint arm(options, 50, damping);  // far more drag than the device bears
    arm.loop.start(axis(0.2), axis(0.2), static_cast<std::uint64_t>(trial));
    double x = 0.2, v = 0;
    const double pull = 40 * any(random), rate = 400 * any(random);
    for (int k = 0; k < 2000; ++k) {
      const MasterTick& tick = arm.loop.master(k * period_s, axis(x));
      if (k % options.slave_periods == 0) arm.loop.slave(k * period_s, axis(0));
      // A spring hand that swings about the layers, at some frequency.
      const double wanted = 0.3 + 0.1 * std::sin(rate * k * period_s);
      v += period_s / 0.01 * (pull * (wanted - x) + tick.aid[0] - damping * v);
      x += period_s * v;
    }
    EXPECT_TRUE(arm.loop.energy().passive) << trial << ": " << arm.loop.energy().lowest;
    EXPECT_GT(arm.loop.energy().device, 0);
  }
}

// A handle leads the tool, and what comes back through it does the same work.
TEST(Loop, AHandleLeadsTheToolAndIsPushedByItsTorques) {
  const RobotModel robot = one_joint();
  EXPECT_THROW(Lead(robot, AxisKind::cartesian, 7, Pose::Identity()), Error);
  Lead lead(robot, AxisKind::joints, -1, Pose::Identity());
  EXPECT_EQ(lead.axis_count(), 1);
  lead.start(axis(0.3), axis(0));
  lead.follow(axis(0.1), 0.5);
  EXPECT_NEAR(lead.q()[0], 0.35, 1e-12) << "half the speed, half the way";
}

TEST(Teleoperation, RestartedIsAsNew) {
  const LoopOptions options;
  OneJoint arm(options, 0.02, 0.4);
  const auto run = [&] {
    arm.loop.start(axis(0.2), axis(0.2), 0);
    std::vector<double> forces;
    for (int k = 0; k < 400; ++k) {
      forces.push_back(arm.loop.master(k * period_s, axis(0.2 + 0.0005 * k)).aid[0]);
    }
    forces.push_back(arm.aid.output().energy.drag);
    return forces;
  };
  const auto first = run();
  EXPECT_EQ(first, run());
}

}  // namespace
}  // namespace vicinity
