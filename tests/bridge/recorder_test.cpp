// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What is recorded of states that are no place, and what becomes of an earlier recording.

#include "recorder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>

#include "cli/small_arm.h"
#include "mcap/reader.h"
#include "ros2/cdr.h"
#include "ros2/topics.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity::bridge {
namespace {

class Recording : public testing::Test {
 protected:
  Recording() : folder_(mkdtemp(name_.data())) {}
  ~Recording() override { std::filesystem::remove_all(folder_); }

  std::string name_ = (std::filesystem::temp_directory_path() / "vicinity_record_XXXXXX").string();
  std::filesystem::path folder_;
};

TEST_F(Recording, HoldsNothingThatIsNotFinite) {
  cli::Arm arm;
  arm.robot = parse_urdf(cli_test::small_arm, "the small arm").robot;
  arm.points = sample_body_points(arm.robot, {});
  FieldInUse in_use(arm);
  Scene scene;
  scene.voxel_size = 0.05;
  scene.objects.push_back({.name = "block", .shape = primitive::box({0.2, 0.1, 0.1})});
  in_use.offer(build_field(scene).field);
  {
    Recorder recorder(folder_ / "felt.mcap", in_use, arm.robot, -1);
    Answer answer;
    answer.sample.heard = Heard::state;
    answer.sample.q = answer.sample.qd = AxisVector::Zero(3);
    answer.output.torque = AxisVector::Zero(3);
    for (int n = 0; n < 3; ++n) {
      const bool odd = n == 1;
      answer.sample.stamp = {1, static_cast<std::uint32_t>(n)};
      answer.sample.q[0] = odd ? std::numeric_limits<double>::quiet_NaN() : 0.5;
      answer.output.status = odd ? Status::not_finite : Status::ok;
      recorder.add(answer);
    }
  }
  std::map<std::string, int> messages;
  mcap::read(folder_ / "felt.mcap", [&](const auto&, const auto& channel, const auto& message) {
    ++messages[channel.topic];
    if (channel.topic != ros2::topic::wrench) return;
    ros2::WrenchStamped said;
    ASSERT_TRUE(ros2::read_cdr(message.data, said));
    EXPECT_TRUE(std::isfinite(said.wrench.force.x));
  });
  EXPECT_EQ(messages["/joint_states"], 2);
  EXPECT_EQ(messages["/vicinity/wrench"], 2);
  EXPECT_EQ(messages["/diagnostics"], 3) << "ok, not finite, ok";
}

TEST_F(Recording, KeepsTheEarlierOnes) {
  const std::filesystem::path path = folder_ / "felt.mcap";
  EXPECT_EQ(keep_earlier(path), std::filesystem::path());
  std::ofstream(path) << "first";
  EXPECT_EQ(keep_earlier(path), folder_ / "felt.1.mcap");
  std::ofstream(path) << "second";
  EXPECT_EQ(keep_earlier(path), folder_ / "felt.2.mcap");
  EXPECT_FALSE(std::filesystem::exists(path));
  std::string text;
  std::ifstream(folder_ / "felt.1.mcap") >> text;
  EXPECT_EQ(text, "first");
}

}  // namespace
}  // namespace vicinity::bridge
