// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The bridge on a real wire, the loopback address: as another vendor's program meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "bridge.h"
#include "cli/small_arm.h"
#include "dds/participant.h"
#include "interruption.h"
#include "mcap/reader.h"
#include "ros2/messages.h"
#include "ros2/topics.h"
#include "vicinity/geometry/error.h"

namespace vicinity::bridge {
namespace {

// Tests that run beside each other do not meet.
std::uint32_t own_domain() { return 100 + static_cast<std::uint32_t>(getpid()) % 100; }

constexpr const char* block = R"(
voxel_size: 0.01
objects:
  - name: block
    primitive: {box: {size: [0.2, 0.1, 0.1]}}
)";

TEST(Endpoints, CarryTheTypeHashAndTheNamesOfRos2) {
  dds::Participant ours({.domain = own_domain(), .configuration = {}, .name_space = "/left"});
  dds::Sample bytes;
  const dds_entity_t writer = ours.writer<ros2::JointState>(ros2::topic::joint_states);
  const dds_entity_t reader = ours.reader<ros2::JointState>(ros2::topic::joint_states);
  ros2::JointState said;
  said.name = {"a"};
  said.position = {0.5};
  ASSERT_TRUE(dds::send(writer, said, bytes));
  dds::Participant::Waiter(ours, {reader}).wait(10);
  ASSERT_TRUE(dds::take(reader, bytes));
  ros2::JointState heard;
  ASSERT_TRUE(ros2::read_cdr(bytes, heard));
  EXPECT_EQ(heard.position, said.position);

  EXPECT_TRUE(dds::is_heard(writer));
  EXPECT_FALSE(dds::is_heard(ours.writer<ros2::JointState>(ros2::topic::joint_efforts)));

  dds_instance_handle_t match = 0;
  ASSERT_EQ(dds_get_matched_publications(reader, &match, 1), 1);
  dds_builtintopic_endpoint_t* sender = dds_get_matched_publication_data(reader, match);
  ASSERT_NE(sender, nullptr);
  EXPECT_STREQ(sender->topic_name, "rt/left/joint_states");
  EXPECT_STREQ(sender->type_name, "sensor_msgs::msg::dds_::JointState_");
  void* data = nullptr;
  size_t size = 0;
  ASSERT_TRUE(dds_qget_userdata(sender->qos, &data, &size));
  EXPECT_EQ(std::string(static_cast<const char*>(data), size),
            "typehash=RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e;");
  dds_free(data);
  dds_builtintopic_free_endpoint(sender);
}

// Two seconds at 1 kHz, there and back; how many got lost is printed, and depends on the machine.
TEST(CrossVendor, FastDdsPublishesJointStatesAndReadsWrenches) {
  std::string name = (std::filesystem::temp_directory_path() / "vicinity_bridge_XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(name.data());
  std::ofstream(folder / "scene.yaml") << block;
  std::ofstream(folder / "arm.urdf") << cli_test::small_arm;
  BridgeOptions options;
  options.input = folder / "scene.yaml";
  options.arm.robot = folder / "arm.urdf";
  options.arm.base = cli_test::small_arm_base;
  options.domain = own_domain();
  options.recording = folder / "felt.mcap";
  options.seconds = 7;
  options.json = true;
  std::ostringstream out, err;
  std::thread bridging([&] { bridge(options, out, err); });

  const std::string command = VICINITY_FAST_DDS_PEER " " + std::to_string(options.domain) + " 2";
  std::FILE* peer = popen(command.c_str(), "r");
  ASSERT_NE(peer, nullptr);
  char line[1000] = {};
  EXPECT_NE(std::fgets(line, sizeof line, peer), nullptr);
  EXPECT_EQ(pclose(peer), 0);
  bridging.join();
  std::printf("Fast DDS: %sbridge: %s\n", line, out.str().c_str());

  const auto theirs = nlohmann::json::parse(line), ours = nlohmann::json::parse(out.str());
  EXPECT_EQ(theirs["sent"], 2000);
  EXPECT_GT(theirs["wrenches"], 0);
  EXPECT_EQ(theirs["backwards"], 0);
  EXPECT_GT(theirs["strongest"].get<double>(), 0) << "nothing was felt";
  EXPECT_EQ(theirs["frame"], "finger");
  // What was heard was answered, and nothing else was: messages, and the times without any.
  std::uint64_t answers = 0, without = 0;
  for (const auto& [status, count] : ours["statuses"].items()) {
    (status == "silence" || status == "nothing yet" ? without : answers) +=
        count.get<std::uint64_t>();
  }
  EXPECT_EQ(answers + ours["no_room"].get<std::uint64_t>(), ours["joint_states"]);
  EXPECT_GT(without, 0u);
  EXPECT_TRUE(ours["energy"]["passive"].get<bool>());
  // And recorded, up to the end.
  std::uint64_t recorded = 0;
  const mcap::Ending ending =
      mcap::read(options.recording, [&](const auto&, const auto& channel, const auto&) {
        recorded += channel.topic == ros2::topic::joint_states ? 1 : 0;
      });
  EXPECT_TRUE(ending.whole);
  EXPECT_GT(recorded, 0u);
  EXPECT_LE(recorded, answers);
  std::filesystem::remove_all(folder);
}

TEST(Bridge, RefusesWhatCannotBeUsed) {
  std::ostringstream out, err;
  BridgeOptions options;
  options.domain = 5000;
  EXPECT_THROW(bridge(options, out, err), std::exception);
  options.domain = 0;
  options.name_space = "left";
  EXPECT_THROW(bridge(options, out, err), std::exception);
  options.name_space.clear();
  options.half_speed_drag = 0;
  EXPECT_THROW(bridge(options, out, err), std::exception);
  options.half_speed_drag = 1;
  options.follow_field = "/cell";
  options.input = "scene.yaml";
  EXPECT_THROW(bridge(options, out, err), std::exception) << "no place for a copy";
  options.follow_field.clear();
  for (const char* name : {"cell", "/", "/a cell", "/cell/"}) {
    options.share_field = name;
    EXPECT_THROW(bridge(options, out, err), std::exception) << name;
  }
  options.share_field.clear();
  options.dds = "nowhere.xml";
  EXPECT_THROW(bridge(options, out, err), std::exception);
  options.dds.clear();
  constexpr double infinite = std::numeric_limits<double>::infinity();
  options.half_speed_drag = infinite;
  EXPECT_THROW(bridge(options, out, err), std::exception);
  options.half_speed_drag = 1;
  for (const double seconds : {0.0, -1.0, infinite, std::numeric_limits<double>::quiet_NaN()}) {
    options.seconds = seconds;
    EXPECT_THROW(bridge(options, out, err), std::exception) << seconds;
  }
  options.seconds.reset();
  options.recording = "felt.csv";
  EXPECT_THROW(bridge(options, out, err), std::exception);
}

// Before there is a field, which the follower may never see.
TEST(Bridge, RefusesADeviceForAnotherArmAtTheStart) {
  std::string name = (std::filesystem::temp_directory_path() / "vicinity_device_XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(name.data());
  std::ofstream(folder / "arm.urdf") << cli_test::small_arm;
  std::ofstream(folder / "device.yaml") << "name: two axes\naxes: joints\naxis_count: 2\n"
                                           "physical_damping: [0.3, 0.2]\n"
                                           "torque_limits: [4, 3]\n";
  BridgeOptions options;
  options.input = folder / "copy.vicinity";
  options.follow_field = "/cell";
  options.arm.robot = folder / "arm.urdf";
  options.arm.device = folder / "device.yaml";
  options.domain = own_domain();
  options.seconds = 0.2;
  std::ostringstream out, err;
  try {
    bridge(options, out, err);
    ADD_FAILURE() << "it runs: " << err.str();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("it is for another arm"));
  }
  std::filesystem::remove_all(folder);
}

TEST(Bridge, ASignalIsHowItEnds) {
  struct sigaction before {};
  ASSERT_EQ(sigaction(SIGTERM, nullptr, &before), 0);
  cli::catch_interruptions();
  {
    const cli::UntilAsked until_asked;
    EXPECT_FALSE(cli::interruption_asked());
    raise(SIGTERM);
    EXPECT_TRUE(cli::interruption_asked());
  }
  EXPECT_FALSE(cli::interruption_asked()) << "whatever comes next would end too";
  sigaction(SIGTERM, &before, nullptr);
  sigaction(SIGINT, &before, nullptr);
}

}  // namespace
}  // namespace vicinity::bridge
