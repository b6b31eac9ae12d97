// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// MuJoCo's arm beside ours: the same kinematics, and contact forces that balance what presses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <random>

#include "simulation/gantry.h"
#include "simulation/world.h"
#include "vicinity/geometry/error.h"
#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/robot/urdf_file.h"

namespace vicinity {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::shared_ptr<const VoxelBoxes> block_boxes() { return block_workplace().boxes; }

std::filesystem::path kinova() {
  const char* const data = std::getenv("VICINITY_DATA");
  const std::filesystem::path file =
      std::filesystem::path(data ? data : "") /
      "robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/urdf/"
      "GEN3-7DOF-NOVISION_FOR_URDF_ARM_V12.urdf";
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

AxisVector random_joints(Eigen::Index n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> angle(-2, 2);
  AxisVector q(n);
  for (double& each : q) each = angle(random);
  return q;
}

void expect_same_kinematics(const RobotModel& robot, const Pose& X_WB) {
  World world(robot, block_boxes(), {.X_WB = X_WB});
  ForwardKinematics ours(robot);
  std::mt19937_64 random(7);
  const auto n = static_cast<Eigen::Index>(robot.coordinates.size());
  const AxisVector still = AxisVector::Zero(n);
  for (int trial = 0; trial < 50; ++trial) {
    const AxisVector q = random_joints(n, random);
    SCOPED_TRACE(testing::PrintToString(std::vector<double>(q.begin(), q.end())));
    world.start(q);
    ours.update(q.data(), still.data(), X_WB);
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      const Pose theirs = world.X_WL(link);
      ASSERT_LT((theirs.translation() - ours.p_WL(link)).norm(), 1e-9) << robot.links[link].name;
      ASSERT_LT((theirs.linear() - ours.R_WL(link)).norm(), 1e-9) << robot.links[link].name;
    }
  }
}

TEST(World, KinematicsOfTheDemoArmAreOursToANanometre) {
  expect_same_kinematics(
      read_urdf(std::filesystem::path(VICINITY_SCENES) / "hot_cell_arm.urdf").robot,
      pose_from_rpy({0.95, 1.1, 0}, {0.1, -0.2, 0.3}));
}

TEST(World, KinematicsOfTheKinovaAreOursToANanometre) {
  if (kinova().empty()) GTEST_SKIP() << "no Kinova in VICINITY_DATA";
  expect_same_kinematics(read_urdf(kinova()).robot, Pose::Identity());
}

// By another route: MuJoCo reads the URDF itself.
TEST(World, MuJoCosOwnReaderOfTheUrdfPutsTheLinksWhereWeDo) {
  const auto path = std::filesystem::path(VICINITY_SCENES) / "hot_cell_arm.urdf";
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string robot_tag = "<robot name=\"hot_cell_arm\">";
  text.insert(text.find(robot_tag) + robot_tag.size(),
              "<mujoco><compiler fusestatic=\"false\"/></mujoco>");
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "arm.urdf", static_cast<int>(text.size()) + 1);
  std::memcpy(files->filedata[0], text.c_str(), text.size() + 1);
  char why[500] = "";
  mjModel* const model = mj_loadXML("arm.urdf", files.get(), why, sizeof why);
  mj_deleteVFS(files.get());
  ASSERT_NE(model, nullptr) << why;
  mjData* const data = mj_makeData(model);

  const RobotModel robot = read_urdf(path).robot;
  ForwardKinematics ours(robot);
  std::mt19937_64 random(11);
  const AxisVector still = AxisVector::Zero(7);
  for (int trial = 0; trial < 20; ++trial) {
    const AxisVector q = random_joints(7, random);
    std::copy(q.begin(), q.end(), data->qpos);
    mj_kinematics(model, data);
    ours.update(q.data(), still.data(), Pose::Identity());
    for (std::size_t link = 1; link < robot.links.size(); ++link) {
      const int body = mj_name2id(model, mjOBJ_BODY, robot.links[link].name.c_str());
      ASSERT_GE(body, 0) << robot.links[link].name;
      EXPECT_LT((Eigen::Map<const Vec3>(data->xpos + 3 * body) - ours.p_WL(link)).norm(), 1e-9)
          << robot.links[link].name;
    }
  }
  mj_deleteData(data);
  mj_deleteModel(model);
}

TEST(World, WhatLiesOnTheBlockPressesWithItsWeight) {
  World world(gantry(), block_boxes());
  AxisVector q = AxisVector::Zero(3);
  q[2] = gantry_ball + 0.012;  // the boxes stand out from the block by less than a voxel
  world.start(q);
  world.let_go();
  const AxisVector still = AxisVector::Zero(3);
  for (int step = 0; step < 2000; ++step) ASSERT_TRUE(world.step(q, still));
  ASSERT_GT(world.contacts().count, 0);
  EXPECT_NEAR(world.contacts().force, gantry_tool_kg * 9.81, 0.01 * gantry_tool_kg * 9.81);
  EXPECT_NEAR(world.contacts().force_W.z(), gantry_tool_kg * 9.81, 0.08);
}

TEST(World, TheServoPressesWithTheForceThatItReports) {
  World world(gantry(), block_boxes());
  AxisVector q = AxisVector::Zero(3);
  q[2] = 0.06;
  world.start(q);
  const AxisVector still = AxisVector::Zero(3);
  for (const double below : {0.005, 0.02}) {
    q[2] = gantry_ball - below;
    for (int step = 0; step < 1500; ++step) ASSERT_TRUE(world.step(q, still));
    ASSERT_GT(world.contacts().force, 1);
    EXPECT_NEAR(world.contacts().force, -world.tau2()[2], 0.01 * world.contacts().force);
  }
}

TEST(World, ImpactSpeedIsThatOfTheWayThere) {
  World world(gantry(), block_boxes());
  AxisVector q = AxisVector::Zero(3), qd = q;
  q[2] = 0.15;
  qd[2] = -0.3;
  world.start(q);
  double impact = 0;
  for (int step = 0; step < 1000 && impact == 0; ++step) {
    q[2] -= 0.3 * world.step_s();
    ASSERT_TRUE(world.step(q, qd));
    impact = world.contacts().closing_speed;
  }
  EXPECT_NEAR(impact, 0.3, 0.01);
}

TEST(World, FreeSpaceIsFree) {
  World world(gantry(), block_boxes());
  AxisVector q = AxisVector::Zero(3);
  q[2] = 0.1;
  world.start(q);
  for (int step = 0; step < 200; ++step) ASSERT_TRUE(world.step(q, AxisVector::Zero(3).eval()));
  EXPECT_EQ(world.contacts().count, 0);
  EXPECT_LT((world.q() - q).norm(), 1e-6) << "gravity is balanced";
  EXPECT_LT(world.tau2().norm(), 1e-3);
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "not refused";
}

TEST(World, RefusesWhatCannotBeSimulatedWithASentence) {
  EXPECT_THAT(refusal([] { World(gantry(false), block_boxes()); }),
              AllOf(HasSubstr("no inertia"), HasSubstr("x_slide")));
  for (const double step_s : {0.0, -0.001, 0.0051, 1.0, HUGE_VAL}) {
    EXPECT_THAT(refusal([&] { World(gantry(), block_boxes(), {.step_s = step_s}); }),
                HasSubstr("time step"));
  }
}

TEST(World, BlowsNothingUpWhenItIsLedThroughTheBlock) {
  World world(gantry(), block_boxes());
  AxisVector q = AxisVector::Zero(3);
  q[2] = 0.1;
  world.start(q);
  q[2] = -0.5;  // asked to be half a metre further down at once
  for (int step = 0; step < 1000; ++step) {
    world.step(q, AxisVector::Zero(3).eval());
    ASSERT_TRUE(world.q().allFinite());
    ASSERT_LT(world.q().cwiseAbs().maxCoeff(), 1.0);
  }
}

}  // namespace
}  // namespace vicinity
