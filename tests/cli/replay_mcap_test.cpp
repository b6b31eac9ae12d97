// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity replay and MCAP: what it writes says what its CSV says, and what anybody recorded in
// ROS 2's joint states moves the arm as a CSV of the same motion does.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "mcap/reader.h"
#include "mcap/writer.h"
#include "replay_fixture.h"
#include "ros2/cdr.h"
#include "ros2/messages.h"
#include "ros2/schema.h"
#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/robot/urdf_file.h"

namespace vicinity::cli_test {
namespace {

using testing::HasSubstr;

template <class Message>
std::vector<Message> all_on(const std::filesystem::path& file, const std::string& topic) {
  std::vector<Message> all;
  mcap::read(file, [&](const auto& schema, const auto& channel, const auto& message) {
    if (channel.topic != topic) return;
    EXPECT_EQ(schema.name, Message::type);
    EXPECT_TRUE(ros2::read_cdr(message.data, all.emplace_back()));
  });
  return all;
}

double seconds(const ros2::Time& stamp) { return stamp.sec + 1e-9 * stamp.nanosec; }

// A recording by somebody else: joint states on a topic, and nothing of ours.
std::string recorded_states(const std::vector<ros2::JointState>& states,
                            const std::string& topic = "/joint_states") {
  std::string bytes;
  mcap::Writer writer([&](std::string_view next) { bytes += next; }, "ros2", "somebody else");
  const std::uint16_t channel = writer.add_channel(
      topic,
      writer.add_schema(ros2::JointState::type, "ros2msg",
                        ros2::schema_text(ros2::Describer::of<ros2::JointState>())),
      "cdr");
  std::vector<std::byte> said;
  for (const ros2::JointState& state : states) {
    ros2::write_cdr(state, said);
    writer.write(channel, static_cast<std::uint64_t>(1e9 * seconds(state.header.stamp)), said);
    if (writer.messages() % 100 == 0) writer.close_chunk();
  }
  writer.finish();
  return bytes;
}

std::vector<ros2::JointState> states_of(const Motion& motion, const std::vector<double>& times) {
  std::vector<ros2::JointState> states;
  for (const double t : times) {
    const Vec3 q = motion(t);
    const auto ns = std::llround(1e9 * t);
    ros2::JointState& state = states.emplace_back();
    state.header.stamp = {static_cast<std::int32_t>(ns / 1'000'000'000),
                          static_cast<std::uint32_t>(ns % 1'000'000'000)};
    state.name = {"slide", "turn", "bend"};  // the sender's order, not the robot's
    state.position = {q.z(), q.x(), q.y()};
  }
  return states;
}

TEST_F(Replay, AnMcapRecordingSaysWhatTheCsvSays) {
  ASSERT_EQ(replay("log.csv", {"-o", "felt.csv"}).code, 0);
  ASSERT_EQ(replay("log.csv", {"-o", "felt.mcap"}).code, 0);
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  const auto file = *folder_ / "felt.mcap";
  const auto states = all_on<ros2::JointState>(file, "/joint_states");
  const auto efforts = all_on<ros2::JointState>(file, "/vicinity/joint_efforts");
  const auto wrenches = all_on<ros2::WrenchStamped>(file, "/vicinity/wrench");
  const auto forces = all_on<ros2::Float64>(file, "/vicinity/master_force");
  ASSERT_EQ(states.size(), rows.size());
  ASSERT_EQ(efforts.size(), rows.size());
  ASSERT_EQ(wrenches.size(), rows.size());
  ASSERT_EQ(forces.size(), rows.size());
  const RobotModel robot = read_urdf(*folder_ / "arm.urdf").robot;
  ForwardKinematics kinematics(robot);
  const Vec3 rest = Vec3::Zero();
  double most = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    EXPECT_NEAR(seconds(states[k].header.stamp), std::stod(row.at("t")), 1e-9);
    EXPECT_THAT(states[k].name, testing::ElementsAre("turn", "bend", "slide"));
    EXPECT_NEAR(states[k].position[1], std::stod(row.at("q_bend")), 1e-9);
    EXPECT_NEAR((Vec3(efforts[k].effort.data()) - torque_of(row)).norm(), 0, 1e-8);
    EXPECT_NEAR(forces[k].data, std::stod(row.at("master_force")), 1e-6);
    // The wrench is in the tool's axes; the CSV's in the workspace's.
    kinematics.update(states[k].position.data(), rest.data(), small_arm_X_WB());
    const ros2::Vector3& f = wrenches[k].wrench.force;
    const Vec3 force_W = kinematics.R_WL(robot.links.size() - 1) * Vec3(f.x, f.y, f.z);
    EXPECT_NEAR(force_W.x(), std::stod(row.at("fx")), 1e-8);
    EXPECT_NEAR(force_W.z(), std::stod(row.at("fz")), 1e-8);
    most = std::max(most, force_W.norm());
  }
  EXPECT_GT(most, 1e-3) << "nothing was felt";
  EXPECT_EQ(wrenches[0].header.frame_id, robot.links.back().name);
  // Diagnostics come where something changed.
  const auto said = all_on<ros2::DiagnosticArray>(file, "/diagnostics");
  std::size_t at = 0;
  const auto value = [](const ros2::DiagnosticStatus& status, const std::string& key) {
    const auto found = std::ranges::find(status.values, key, &ros2::KeyValue::key);
    return found == status.values.end() ? std::string() : found->value;
  };
  for (const Row& row : rows) {
    const double t = std::stod(row.at("t"));
    while (at + 1 < said.size() && seconds(said[at + 1].header.stamp) <= t + 1e-6) ++at;
    const ros2::DiagnosticStatus& status = said[at].status.at(0);
    ASSERT_EQ(status.message, row.at("status")) << t;
    ASSERT_EQ(value(status, "link"), row.at("reason_link")) << t;
    ASSERT_EQ(value(status, "object"), row.at("reason_object")) << t;
    ASSERT_EQ(value(status, "rank"), row.at("reason_rank")) << t;
  }
}

// What Foxglove reads by. It compares all messages with the CSV, and exits with 0.
TEST_F(Replay, ThePublicReaderReadsAnMcapRecordingAsTheCsv) {
#ifdef VICINITY_MCAP_READER
  const std::filesystem::path script = std::filesystem::path(VICINITY_MCAP_READER) / "read.mjs";
  if (!std::filesystem::exists(script)) GTEST_SKIP() << "npm could not install the public reader";
  ASSERT_EQ(replay("log.csv", {"-o", "felt.csv"}).code, 0);
  ASSERT_EQ(replay("log.csv", {"-o", "felt.mcap"}).code, 0);
  const std::string command = "node " + script.string() + " " + (*folder_ / "felt.mcap").string() +
                              " " + (*folder_ / "felt.csv").string();
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
#else
  GTEST_SKIP() << "no npm: recordings are not opened with the public reader";
#endif
}

TEST_F(Replay, ReplaysJointStatesThatSomebodyElseRecorded) {
  folder_->write("states.mcap", recorded_states(states_of(parabola, every(1000, length_s))));
  const Answer answer = replay("states.mcap", {"-o", "felt.csv"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  expect_equal(rows_of(*folder_ / "felt.csv"), direct(parabola, 901), 1e-6);
}

TEST_F(Replay, ReplaysItsOwnRecordingToTheSameTorques) {
  ASSERT_EQ(replay("log.csv", {"-o", "felt.mcap"}).code, 0);
  ASSERT_EQ(replay("felt.mcap", {"-o", "again.csv"}).code, 0);
  expect_equal(rows_of(*folder_ / "again.csv"), direct(parabola, 901), 1e-6);
}

TEST_F(Replay, ReplaysACutRecordingUpToTheCutAndSaysSo) {
  const std::string whole = recorded_states(states_of(parabola, every(1000, length_s)));
  folder_->write("cut.mcap", whole.substr(0, whole.size() / 2));
  const Answer answer = replay("cut.mcap", {"-o", "felt.csv"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("was cut off"));
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  ASSERT_GT(rows.size(), 100u);
  ASSERT_LT(rows.size(), 901u);
  EXPECT_EQ(rows.size() % 100, 0u) << "whole chunks of 100 messages";
  expect_equal(rows, direct(parabola, static_cast<int>(rows.size())), 1e-6);
}

TEST_F(Replay, RefusesRecordingsThatHoldNoMotion) {
  const auto refused = [&](const std::string& bytes, const std::string& says) {
    folder_->write("odd.mcap", bytes);
    const Answer answer = replay("odd.mcap", {"-o", "never.csv"});
    EXPECT_EQ(answer.code, 2) << answer.out;
    EXPECT_THAT(answer.err, HasSubstr(says));
  };
  const std::vector<ros2::JointState> states = states_of(parabola, every(1000, 0.5));
  std::string damaged = recorded_states(states);
  refused("t,turn,bend,slide\n0,0,0,0\n", "not an MCAP recording");
  refused(recorded_states({}), "no joint states");
  refused(damaged.substr(0, 500), "cut off before its first joint state");
  damaged[damaged.size() / 2] ^= 1;
  refused(damaged, "damaged");
  std::vector<ros2::JointState> other = states;
  for (ros2::JointState& state : other) state.name = {"shoulder", "elbow", "wrist"};
  refused(recorded_states(other), "no column for joint 'turn'");
  other = states;
  for (ros2::JointState& state : other) {
    state.position[1] = std::numeric_limits<double>::quiet_NaN();
  }
  refused(recorded_states(other), "no joint states with positions");
}

// One message that is no place spoils no recording; of hardware that measures no velocities ROS 2
// records NaN.
TEST_F(Replay, LeavesOutStatesThatAreNotFiniteAndSaysHowMany) {
  std::vector<ros2::JointState> states = states_of(parabola, every(1000, length_s));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  ros2::JointState odd = states[400];
  odd.header.stamp.nanosec += 500'000;
  odd.position[1] = nan;
  states.insert(states.begin() + 401, 2, odd);
  for (ros2::JointState& state : states) state.velocity = {nan, nan, nan};
  folder_->write("odd.mcap", recorded_states(states));
  const Answer answer = replay("odd.mcap", {"-o", "felt.csv"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("2 joint states on /joint_states hold positions"));
  expect_equal(rows_of(*folder_ / "felt.csv"), direct(parabola, 901), 1e-6);
}

TEST_F(Replay, AnMcapRecordingNeedsTimesThatAStampCanSay) {
  folder_->write("early.csv", "t,turn,bend,slide\n-1,0,0,0\n0,0,0,0\n");
  const Answer answer = replay("early.csv", {"-o", "felt.mcap"});
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, HasSubstr("times of this log"));
}

}  // namespace
}  // namespace vicinity::cli_test
