// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The C header over the same core: bit for bit what C++ gives, and safe against misuse.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "c/in_c.h"
#include "mesh/mesh_data.h"
#include "no_allocation.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/teleop/tick.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field_file.h"

namespace vicinity {
namespace {

using testing::HasSubstr;

constexpr const char* two_links = R"(<robot name="two_links">
  <link name="foot"/>
  <link name="upper">
    <collision><origin xyz="0.1 0 0"/><geometry><box size="0.2 0.03 0.03"/></geometry></collision>
  </link>
  <link name="lower">
    <collision><origin xyz="0.1 0 0"/><geometry><box size="0.2 0.02 0.02"/></geometry></collision>
  </link>
  <joint name="turn" type="continuous">
    <parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="bend" type="revolute">
    <parent link="upper"/><child link="lower"/><origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" velocity="3" effort="5"/>
  </joint>
</robot>
)";

ViscosityField ball_at(const Vec3& p_WO, const char* name) {
  Scene scene;
  scene.voxel_size = 0.01;
  SceneObject ball{.name = name, .shape = primitive::sphere(0.08)};
  ball.X_WO.translation() = p_WO;
  scene.objects.push_back(ball);
  return build_field(scene).field;
}

class InC : public testing::Test {
 protected:
  InC() {
    save_field(ball_at({0.2, 0.1, -0.1}, "ball"), field_);
    save_field(ball_at({0.25, 0.1, -0.12}, "other"), other_field_);
  }
  void TearDown() override { vicinity_destroy(arm_); }

  vicinity_arm* create(const vicinity_options& options) {
    return arm_ = vicinity_create(field_.c_str(), urdf_.c_str(), &options);
  }

  ScratchFolder folder_;
  std::filesystem::path field_ = folder_.path() / "f.vicinity";
  std::filesystem::path other_field_ = folder_.path() / "other.vicinity";
  std::filesystem::path urdf_ = folder_.file("arm.urdf", two_links);
  vicinity_arm* arm_ = nullptr;
};

TEST_F(InC, TicksAreTheCoresBitForBit) {
  constexpr int ticks = 2500;
  const std::filesystem::path device = folder_.file(
      "device.yaml", "name: bench\naxes: joints\naxis_count: 2\nphysical_damping: 0.002\n");
  vicinity_options options = vicinity_default_options();
  const char* const exclude[] = {"upper"};
  options.exclude = exclude;
  options.exclude_count = 1;
  options.points = 400;
  options.memory = "rising";
  options.direction = VICINITY_CLOSING;
  options.device = device.c_str();
  options.gain = 2;
  ASSERT_NE(create(options), nullptr) << vicinity_last_error();
  std::vector<vicinity_output> in_c(ticks);
  {
    const NoAllocation guard;
    in_c_replay(arm_, ticks, in_c.data());
  }

  const RobotModel robot = read_urdf(urdf_).robot;
  BodyPointOptions points;
  points.exclude = {"upper"};
  points.total = 400;
  TeleoperationOptions core;
  core.memory = named_memory("rising");
  core.direction = DragDirection::closing;
  core.limiter = limiter_options(read_device(device), LimiterMode::strict);
  core.master.gain = 2;
  Teleoperation teleoperation(robot, sample_body_points(robot, points), open_field(field_), core);
  Output output;
  double felt = 0;
  for (int k = 0; k < ticks; ++k) {
    double q[2];
    in_c_motion(k, q);
    const double* b = in_c_base;
    const Input input{.time_s = 1e-3 * k,
                      .q = q,
                      .joint_count = 2,
                      .X_WB = pose_from_rpy({b[0], b[1], b[2]}, {b[3], b[4], b[5]}),
                      .tau2 = 0.25};
    const Status status = teleoperation.tick(input, output);
    const vicinity_output& c = in_c[static_cast<std::size_t>(k)];
    ASSERT_EQ(static_cast<int>(c.status), static_cast<int>(status)) << "tick " << k;
    ASSERT_EQ(c.joint_count, 2);
    ASSERT_EQ(std::memcmp(c.torque, output.torque.data(), 2 * sizeof(double)), 0) << "tick " << k;
    ASSERT_EQ(std::memcmp(c.force, output.tool.force.data(), sizeof c.force), 0) << "tick " << k;
    ASSERT_EQ(std::memcmp(c.moment, output.tool.moment.data(), sizeof c.moment), 0) << "tick " << k;
    ASSERT_EQ(c.master_force, output.master_force);
    ASSERT_EQ(c.scale, output.limiter.scale);
    ASSERT_EQ(c.energy_drag, output.energy.drag);
    ASSERT_EQ(c.passive, output.energy.passive ? 1 : 0);
    ASSERT_EQ(c.reason_link, output.reason.link);
    ASSERT_EQ(c.reason_object, output.reason.object);
    ASSERT_EQ(c.points_felt, output.counts.points_felt);
    felt += output.torque.norm();
  }
  EXPECT_GT(felt, 0);
  EXPECT_EQ(in_c.back().ticks, static_cast<std::uint64_t>(ticks));
}

TEST_F(InC, NamesJointsLinksAndObjects) {
  ASSERT_NE(create(vicinity_default_options()), nullptr) << vicinity_last_error();
  EXPECT_STREQ(vicinity_last_error(), "");
  EXPECT_EQ(vicinity_joint_count(arm_), 2);
  EXPECT_STREQ(vicinity_joint_name(arm_, 1), "bend");
  EXPECT_STREQ(vicinity_link_name(arm_, 2), "lower");
  EXPECT_STREQ(vicinity_object_name(arm_, 0), "ball");
}

TEST_F(InC, AnotherFieldIsFeltFromTheNextTickOn) {
  ASSERT_NE(create(vicinity_default_options()), nullptr) << vicinity_last_error();
  vicinity_arm* const never_swapped = vicinity_create(other_field_.c_str(), urdf_.c_str(), nullptr);
  ASSERT_NE(never_swapped, nullptr) << vicinity_last_error();
  ASSERT_EQ(vicinity_swap_field(arm_, other_field_.c_str()), 0) << vicinity_last_error();
  EXPECT_STREQ(vicinity_object_name(arm_, 0), "other");
  std::vector<vicinity_output> swapped(800), plain(800);
  in_c_replay(arm_, 800, swapped.data());
  in_c_replay(never_swapped, 800, plain.data());
  double felt = 0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    ASSERT_EQ(std::memcmp(swapped[k].torque, plain[k].torque, sizeof plain[k].torque), 0) << k;
    felt += plain[k].power;
  }
  EXPECT_GT(felt, 0);
  vicinity_destroy(never_swapped);
}

TEST_F(InC, MisuseIsAnsweredNotSuffered) {
  ASSERT_NE(create(vicinity_default_options()), nullptr) << vicinity_last_error();
  const char* first = "";
  EXPECT_EQ(in_c_misuse(arm_, &first), 0) << first;
}

TEST_F(InC, OptionsThatCannotBeUsedAreRefusedWithOneSentence) {
  struct Refusal {
    const char* says;
    void (*spoil)(vicinity_options&);
  };
  const Refusal refusals[] = {
      {"struct_size", [](vicinity_options& o) { o.struct_size = 8; }},
      {"null pointer", [](vicinity_options& o) { o.exclude_count = 1; }},
      {"points_per_m2", [](vicinity_options& o) { o.points_per_m2 = -1; }},
      {"lower", [](vicinity_options& o) { o.tool = "lowr"; }},
      {"loud", [](vicinity_options& o) { o.memory = "loud"; }},
      {"direction", [](vicinity_options& o) { o.direction = 7; }},
      {"traversal", [](vicinity_options& o) { o.traversal = -1; }},
      {"mode", [](vicinity_options& o) { o.device = "touch", o.mode = 2; }},
      {"touch", [](vicinity_options& o) { o.device = "tuch"; }},
      {"device mode", [](vicinity_options& o) { o.device = "touch"; }},
      {"longest_period_s", [](vicinity_options& o) { o.longest_period_s = 0; }},
      {"longest_period_s", [](vicinity_options& o) { o.longest_period_s = NAN; }},
      {"lever", [](vicinity_options& o) { o.lever = 0; }},
  };
  for (const Refusal& refusal : refusals) {
    vicinity_options options = vicinity_default_options();
    refusal.spoil(options);
    EXPECT_EQ(create(options), nullptr) << refusal.says;
    EXPECT_THAT(vicinity_last_error(), HasSubstr(refusal.says));
  }
}

}  // namespace
}  // namespace vicinity
