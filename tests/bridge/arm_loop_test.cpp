// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What comes over the wire, and what the arm is answered: late, lost, doubled, reordered, of
// another robot, NaN or no message at all. Each has a name, no force, and is over with the next
// good one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "announcer.h"
#include "arm_loop.h"
#include "cli/small_arm.h"
#include "ros2/cdr.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/scene.h"
#include "viscosity/seeds.h"

namespace vicinity::bridge {
namespace {

constexpr std::int64_t start_ns = 1'700'000'000'000'000'000, ms = 1'000'000;

// The block of the small scene, and the small arm going past it.
struct Place {
  Place()
      : robot(parse_urdf(cli_test::small_arm, "the small arm").robot),
        field(build_field(scene()).field) {}

  static Scene scene() {
    Scene made;
    made.voxel_size = 0.01;
    made.objects.push_back({.name = "block", .shape = primitive::box({0.2, 0.1, 0.1})});
    return made;
  }

  RobotModel robot;
  ViscosityField field;
};

class Wire : public testing::Test {
 protected:
  Wire()
      : teleoperation_(place().robot, sample_body_points(place().robot, {}), place().field),
        intake_(place().robot, cli_test::small_arm_X_WB()),
        loop_(std::make_unique<ArmLoop>(3)) {
    loop_->feel(teleoperation_);
  }

  static const Place& place() {
    static const Place made;
    return made;
  }

  // @param ahead_ms  by so much its stamp is later than it should be
  static ros2::JointState state(int k, std::int64_t ahead_ms = 0) {
    const Vec3 q = cli_test::parabola(0.001 * k);
    const std::int64_t ns = start_ns + (k + ahead_ms) * ms;
    ros2::JointState state;
    state.header.stamp = {static_cast<std::int32_t>(ns / 1'000'000'000),
                          static_cast<std::uint32_t>(ns % 1'000'000'000)};
    state.name = {"slide", "gripper", "turn", "bend"};
    state.position = {q.z(), 9, q.x(), q.y()};
    return state;
  }

  // As it arrives. @param delayed_ms  longer under way than the others
  Answer answer_to(const ros2::JointState& said, std::int64_t delayed_ms = 0) {
    std::vector<std::byte> bytes;
    ros2::write_cdr(said, bytes);
    const std::int64_t sent = said.header.stamp.sec * 1'000'000'000LL + said.header.stamp.nanosec;
    return answer_to(bytes, sent + (2 + delayed_ms) * ms);
  }
  std::optional<ArmSample> heard(const std::vector<std::byte>& bytes, std::int64_t arrived_ns) {
    return intake_.joint_state(bytes, {.since_1970_ns = arrived_ns, .monotonic_ns = arrived_ns});
  }
  Answer answer_to(const std::vector<std::byte>& bytes, std::int64_t arrived_ns) {
    const auto sample = heard(bytes, arrived_ns);
    EXPECT_TRUE(sample) << "let be";
    return sample ? answer_to(*sample) : Answer();
  }
  Answer answer_to(const ArmSample& sample) {
    EXPECT_TRUE(loop_->give(sample));
    Answer answer;
    // Answers of silence, where this machine was slow, are none to this message.
    do {
      EXPECT_TRUE(loop_->take(answer, 10'000 * ms));
    } while (answer.sample.heard == Heard::silence || answer.sample.heard == Heard::nothing_yet);
    return answer;
  }

  void follow(int from, int to) {
    for (int k = from; k < to; ++k) (void)answer_to(state(k));
  }

  static bool is_safe(const Answer& answer) {
    return answer.output.torque.size() == 3 && answer.output.torque.isZero(0) &&
           answer.output.tool.force.isZero(0) && answer.output.master_force == 0;
  }

  // The next good messages are felt again, at once or after one that only restarts the velocity.
  void expect_recovery(int k) {
    (void)answer_to(state(k));
    (void)answer_to(state(k + 1));
    const Answer answer = answer_to(state(k + 2));
    EXPECT_STREQ(status_of(answer), "ok");
    EXPECT_FALSE(is_safe(answer)) << "nothing is felt any more";
  }

  Teleoperation teleoperation_;
  Intake intake_;
  std::unique_ptr<ArmLoop> loop_;
};

constexpr int along = 450;  // by then the arm is in the layers

TEST_F(Wire, AnswersEveryStateAsAPlainTickDoes) {
  Teleoperation plain(place().robot, sample_body_points(place().robot, {}), place().field);
  double most = 0;
  for (int k = 0; k < 600; ++k) {
    const Answer answer = answer_to(state(k));
    const Vec3 q = cli_test::parabola(0.001 * k);
    Output output;
    const Input input{
        .time_s = 0.001 * k, .q = q.data(), .joint_count = 3, .X_WB = cli_test::small_arm_X_WB()};
    const Status status = plain.tick(input, output);
    ASSERT_STREQ(status_of(answer), to_string(status)) << k;
    const Vec3 difference = answer.output.torque - output.torque;
    ASSERT_LT(difference.norm(), 1e-6) << k;
    most = std::max(most, output.torque.norm());
  }
  EXPECT_GT(most, 1e-4) << "nothing was felt";
}

TEST_F(Wire, ADoubledMessageIsStaleAndSafe) {
  follow(0, along);
  const Answer answer = answer_to(state(along - 1));
  EXPECT_STREQ(status_of(answer), "time stood still");
  EXPECT_TRUE(is_safe(answer));
  expect_recovery(along);
}

TEST_F(Wire, AMessageOutOfOrderIsSafe) {
  follow(0, along);
  const Answer answer = answer_to(state(along - 5));
  EXPECT_STREQ(status_of(answer), "time ran backwards");
  EXPECT_TRUE(is_safe(answer));
  expect_recovery(along);
}

TEST_F(Wire, AfterALostMessageTheDeadlineIsMissed) {
  follow(0, along);
  const Answer answer = answer_to(state(along + 1));
  EXPECT_STREQ(status_of(answer), "deadline missed");
  EXPECT_TRUE(is_safe(answer));
  expect_recovery(along + 2);
}

TEST_F(Wire, AMessageThatWasUnderWayForLongIsLate) {
  follow(0, along);
  const Answer answer = answer_to(state(along), 60);
  EXPECT_STREQ(status_of(answer), "late");
  EXPECT_TRUE(is_safe(answer));
  expect_recovery(along + 1);
}

TEST_F(Wire, AClockThatIsSetBackIsNamedOnceAndNotLateFromThenOn) {
  follow(0, along);
  const Answer answer = answer_to(state(along, -1000), 1000);
  EXPECT_STREQ(status_of(answer), "time ran backwards");
  EXPECT_TRUE(is_safe(answer));
  for (int k = along + 1; k < along + 100; ++k) {
    ASSERT_STREQ(status_of(answer_to(state(k, -1000), 1000)), "ok") << k;
  }
  EXPECT_STREQ(status_of(answer_to(state(along + 100, -1000), 1060)), "late");
}

TEST_F(Wire, AStampThatIsFarAheadMakesNoOtherLate) {
  follow(0, along);
  const Answer answer = answer_to(state(along, 100'000), -100'000);
  EXPECT_STREQ(status_of(answer), "deadline missed");
  EXPECT_TRUE(is_safe(answer));
  EXPECT_STREQ(status_of(answer_to(state(along + 1))), "time ran backwards");
  expect_recovery(along + 2);
}

TEST_F(Wire, AStampThatIsALittleAheadMakesNoOtherLate) {
  follow(0, along);
  EXPECT_STREQ(status_of(answer_to(state(along, 45), -45)), "deadline missed");
  EXPECT_STREQ(status_of(answer_to(state(along + 1))), "time ran backwards");
  for (int k = along + 2; k < along + 50; ++k) {
    ASSERT_STREQ(status_of(answer_to(state(k), 20)), "ok") << k;
  }
}

TEST_F(Wire, OurOwnClockMayBeSet) {
  follow(0, along);
  for (int k = along; k < along + 50; ++k) {
    std::vector<std::byte> bytes;
    ros2::write_cdr(state(k), bytes);
    const std::int64_t now = start_ns + (k + 2) * ms;
    const auto sample =
        intake_.joint_state(bytes, {.since_1970_ns = now + 1'000'000 * ms, .monotonic_ns = now});
    ASSERT_TRUE(sample);
    ASSERT_STREQ(status_of(answer_to(*sample)), "ok") << k;
  }
}

TEST_F(Wire, AnotherRobotIsNamedSo) {
  follow(0, along);
  ros2::JointState other = state(along);
  other.name = {"slide", "elbow", "wrist", "gripper"};
  const Answer answer = answer_to(other);
  EXPECT_STREQ(status_of(answer), "another robot");
  EXPECT_EQ(level_of(answer), ros2::DiagnosticStatus::error);
  EXPECT_TRUE(is_safe(answer));
  expect_recovery(along + 1);
}

TEST_F(Wire, AnotherDeviceBesideOursIsLetBeAndAloneItIsAnotherRobot) {
  ros2::JointState gripper = state(0);
  gripper.name = {"gripper"};
  gripper.position = {0.1};
  EXPECT_STREQ(status_of(answer_to(gripper)), "another robot");
  std::vector<std::byte> bytes, bare_bytes;
  ros2::write_cdr(gripper, bytes);
  gripper.position.clear();  // a wheel, say: velocities alone
  ros2::write_cdr(gripper, bare_bytes);
  follow(0, along);
  for (int k = along; k < along + 20; ++k) {
    EXPECT_FALSE(heard(bytes, start_ns + k * ms));
    EXPECT_FALSE(heard(bare_bytes, start_ns + k * ms));
    ASSERT_STREQ(status_of(answer_to(state(k))), "ok") << k;
  }
}

// As ROS 2's broadcaster says them of hardware that has none.
TEST_F(Wire, VelocitiesThatAreNaNAreNone) {
  Teleoperation plain(place().robot, sample_body_points(place().robot, {}), place().field);
  for (int k = 0; k < along + 20; ++k) {
    ros2::JointState said = state(k);
    said.velocity.assign(4, 0.0);
    said.velocity[2] = std::numeric_limits<double>::quiet_NaN();
    const Answer answer = answer_to(said);
    const Vec3 q = cli_test::parabola(0.001 * k);
    Output output;
    const Input input{
        .time_s = 0.001 * k, .q = q.data(), .joint_count = 3, .X_WB = cli_test::small_arm_X_WB()};
    ASSERT_STREQ(status_of(answer), to_string(plain.tick(input, output))) << k;
    ASSERT_LT((answer.output.torque - output.torque).norm(), 1e-6) << k;
  }
  expect_recovery(along + 20);
}

TEST_F(Wire, NumbersThatAreNoneAreSafe) {
  follow(0, along);
  for (const double number :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    ros2::JointState odd = state(along);
    odd.position[2] = number;
    const Answer answer = answer_to(odd);
    EXPECT_STREQ(status_of(answer), "not finite");
    EXPECT_TRUE(is_safe(answer));
  }
  expect_recovery(along + 1);
}

TEST_F(Wire, BytesThatAreNoJointStateAreMalformed) {
  follow(0, along);
  ros2::JointState short_list = state(along);
  short_list.position.pop_back();
  EXPECT_STREQ(status_of(answer_to(short_list)), "malformed");
  const Answer answer = answer_to(std::vector<std::byte>(7), start_ns + along * ms);
  EXPECT_STREQ(status_of(answer), "malformed");
  EXPECT_TRUE(is_safe(answer));
  expect_recovery(along + 1);
}

TEST_F(Wire, SurvivesAnyBytes) {
  test::for_each_seed(300, [this](std::mt19937& random) {
    std::vector<std::byte> bytes;
    ros2::write_cdr(state(along), bytes);
    for (int n = test::whole(random, 1, 12); n > 0; --n) {
      const int place = test::whole(random, 0, static_cast<int>(bytes.size()) - 1);
      bytes[static_cast<std::size_t>(place)] = static_cast<std::byte>(test::whole(random, 0, 255));
    }
    const auto sample = heard(bytes, start_ns + along * ms);
    if (!sample) return;  // none of our joints is named any more
    EXPECT_TRUE(answer_to(*sample).output.torque.allFinite());
  });
}

TEST_F(Wire, SilenceIsNamedAndSafeAndEndsWithTheNextState) {
  Answer answer;
  ASSERT_TRUE(loop_->take(answer, 10'000 * ms));
  EXPECT_STREQ(status_of(answer), "nothing yet");
  EXPECT_TRUE(is_safe(answer));
  follow(0, along);
  ASSERT_TRUE(loop_->take(answer, 10'000 * ms));
  EXPECT_STREQ(status_of(answer), "silence");
  EXPECT_EQ(level_of(answer), ros2::DiagnosticStatus::stale);
  EXPECT_TRUE(is_safe(answer));
  expect_recovery(along + 20);
}

TEST_F(Wire, ATransformMovesTheBaseAndABadOneDoesNot) {
  ros2::TFMessage message;
  ros2::TransformStamped& transform = message.transforms.emplace_back();
  transform.header.frame_id = "world";
  transform.child_frame_id = place().robot.links.front().name;
  transform.transform.translation = {1, 2, 3};
  std::vector<std::byte> bytes;
  ros2::write_cdr(message, bytes);
  EXPECT_TRUE(intake_.transforms(bytes, "world"));
  EXPECT_EQ(answer_to(state(0)).sample.X_WB.translation(), Vec3(1, 2, 3));
  transform.transform.translation.x = 5;
  transform.transform.rotation = {0, 0, 0, std::numeric_limits<double>::quiet_NaN()};
  ros2::write_cdr(message, bytes);
  EXPECT_FALSE(intake_.transforms(bytes, "world"));
  transform.transform.rotation = {0, 0, 0, 0};
  ros2::write_cdr(message, bytes);
  EXPECT_FALSE(intake_.transforms(bytes, "world"));
  EXPECT_EQ(answer_to(state(1)).sample.X_WB.translation(), Vec3(1, 2, 3));
}

TEST(SpeedScale, IsHalfWhereTheDragIsTheOneThatHalves) {
  EXPECT_EQ(speed_scale(0, 2), 1);
  EXPECT_EQ(speed_scale(2, 2), 0.5);
  EXPECT_LT(speed_scale(1000, 2), 0.01);
}

}  // namespace
}  // namespace vicinity::bridge
