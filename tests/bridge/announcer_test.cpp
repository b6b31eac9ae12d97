// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The speed scale: what it says while nothing is known of the arm, and that it comes back.

#include "announcer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "cli/small_arm.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity::bridge {
namespace {

class Scale : public testing::Test {
 protected:
  Scale()
      : arm_(small_arm()),
        in_use_(arm_),
        participant_({.domain = 100 + static_cast<std::uint32_t>(getpid()) % 100,
                      .configuration = {},
                      .name_space = {}}),
        announcer_(participant_, in_use_, arm_.robot, -1, half) {
    Scene scene;
    scene.voxel_size = 0.05;
    scene.objects.push_back({.name = "block", .shape = primitive::box({0.2, 0.1, 0.1})});
    in_use_.offer(build_field(scene).field);
  }

  static cli::Arm small_arm() {
    cli::Arm arm;
    arm.robot = parse_urdf(cli_test::small_arm, "the small arm").robot;
    arm.points = sample_body_points(arm.robot, {});
    return arm;
  }

  // @param turning  of the first joint [rad/s]
  double after(Status status, double turning) {
    Answer answer;
    answer.sample.heard = Heard::state;
    answer.sample.q = answer.sample.qd = AxisVector::Zero(3);
    answer.sample.qd[0] = turning;
    answer.sample.has_velocities = true;
    answer.output.status = status;
    answer.output.torque = AxisVector::Zero(3);
    answer.output.power = status <= Status::outside_field ? 0.1 * turning * turning : 0;
    announcer_.announce(answer);
    return announcer_.scale();
  }
  double after(Heard heard) {
    Answer answer;
    answer.sample.heard = heard;
    answer.output.torque = AxisVector::Zero(3);
    announcer_.announce(answer);
    return announcer_.scale();
  }
  // In the midst of a motion against drag.
  double slowed() {
    const double scale = after(Status::ok, 0.5);
    EXPECT_GT(scale, 0);
    EXPECT_LT(scale, 0.9) << "there is no drag";
    return scale;
  }

  static constexpr double half = 1;
  cli::Arm arm_;
  FieldInUse in_use_;
  dds::Participant participant_;
  Announcer announcer_;
};

TEST_F(Scale, ComesBackAfterSilenceThoughTheToolStandsStill) {
  EXPECT_EQ(after(Heard::nothing_yet), 0);
  EXPECT_EQ(after(Status::started, 0), 1);
  const double scale = slowed();
  EXPECT_EQ(after(Status::ok, 0), scale) << "the last value stands";
  EXPECT_EQ(after(Heard::silence), 0);
  EXPECT_EQ(after(Status::deadline_missed, 0), 0);
  EXPECT_EQ(after(Status::ok, 0), 1);
}

TEST_F(Scale, IsZeroWhereNothingThatCanBeFeltComes) {
  const auto for_longer_than_silence = std::chrono::milliseconds(25);
  for (const Heard heard : {Heard::late, Heard::another_robot, Heard::malformed}) {
    const double scale = slowed();
    EXPECT_EQ(after(heard), scale) << to_string(heard) << ": one among good ones";
    std::this_thread::sleep_for(for_longer_than_silence);
    EXPECT_EQ(after(heard), 0) << to_string(heard);
    EXPECT_EQ(after(Status::ok, 0), 1);
  }
  for (const Status status : {Status::not_finite, Status::time_stood_still}) {
    const double scale = slowed();
    EXPECT_EQ(after(status, 0), scale) << to_string(status) << ": one among good ones";
    std::this_thread::sleep_for(for_longer_than_silence);
    EXPECT_EQ(after(status, 0), 0) << to_string(status);
    EXPECT_EQ(after(Status::ok, 0), 1);
  }
}

}  // namespace
}  // namespace vicinity::bridge
