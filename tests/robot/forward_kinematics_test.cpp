// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/robot/forward_kinematics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <functional>
#include <kdl/frames.hpp>
#include <kdl/joint.hpp>
#include <kdl/segment.hpp>
#include <kdl/tree.hpp>
#include <limits>
#include <map>
#include <random>

#include "no_allocation.h"
#include "robot/robots.h"
#include "vicinity/geometry/error.h"
#include "vicinity/robot/urdf_file.h"

namespace vicinity {
namespace {

struct State {
  std::vector<double> q, qd;
  Pose X_WB = Pose::Identity();
};

State random_state(const RobotModel& robot, std::mt19937_64& random) {
  State state;
  for (std::size_t c = 0; c < robot.coordinates.size(); ++c) {
    state.q.push_back(2 * random_vector(random).x());
    state.qd.push_back(random_vector(random).x());
  }
  state.X_WB = random_pose(random);
  return state;
}

void update(ForwardKinematics& arm, const State& state) {
  arm.update(state.q.data(), state.qd.data(), state.X_WB);
}

KDL::Frame to_kdl(const urdf::Pose& pose) {
  const auto& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w),
          {pose.position.x, pose.position.y, pose.position.z}};
}

// The same file by another way: read by urdfdom, moved by KDL, one segment at a time.
struct ByKdl {
  std::map<std::string, KDL::Frame> frame;
  std::map<std::string, KDL::Twist> twist;  // about the link's own origin, in W

  ByKdl(const urdf::ModelInterface& model, const RobotModel& robot, const State& state) {
    const Eigen::Matrix3d R = state.X_WB.linear();
    const Vec3 p = state.X_WB.translation();
    const KDL::Rotation R_WB(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1),
                             R(2, 2));
    const std::string root = model.getRoot()->name;
    frame[root] = KDL::Frame(R_WB, {p.x(), p.y(), p.z()});
    twist[root] = KDL::Twist::Zero();
    descend(*model.getRoot(), robot, state);
  }

  void descend(const urdf::Link& link, const RobotModel& robot, const State& state) {
    for (const auto& joint : link.child_joints) {
      const KDL::Frame X_PJ = to_kdl(joint->parent_to_joint_origin_transform);
      const KDL::Vector axis = X_PJ.M * KDL::Vector(joint->axis.x, joint->axis.y, joint->axis.z);
      const auto type = joint->type == urdf::Joint::FIXED       ? KDL::Joint::Fixed
                        : joint->type == urdf::Joint::PRISMATIC ? KDL::Joint::TransAxis
                                                                : KDL::Joint::RotAxis;
      const KDL::Joint moves = type == KDL::Joint::Fixed
                                   ? KDL::Joint(joint->name, KDL::Joint::Fixed)
                                   : KDL::Joint(joint->name, X_PJ.p, axis, type);
      const KDL::Segment segment(joint->child_link_name, moves, X_PJ);
      double q = 0, qd = 0;
      for (std::size_t c = 0; c < robot.coordinates.size(); ++c) {
        if (robot.joints[static_cast<std::size_t>(robot.coordinates[c])].name != joint->name) {
          continue;
        }
        q = state.q[c];
        qd = state.qd[c];
      }
      const KDL::Frame X_WP = frame.at(link.name), X_PC = segment.pose(q);
      frame[joint->child_link_name] = X_WP * X_PC;
      twist[joint->child_link_name] =
          twist.at(link.name).RefPoint(X_WP.M * X_PC.p) + X_WP.M * segment.twist(q, qd);
      descend(*robot_link(*joint, link), robot, state);
    }
  }

  static urdf::LinkSharedPtr robot_link(const urdf::Joint& joint, const urdf::Link& parent) {
    for (const auto& child : parent.child_links) {
      if (child->name == joint.child_link_name) return child;
    }
    return nullptr;
  }
};

class RealArm : public testing::TestWithParam<const char*> {};

TEST_P(RealArm, MovesAsUrdfdomAndKdlMoveIt) {
  const auto file = robot_file(GetParam());
  if (file.empty()) GTEST_SKIP() << "set VICINITY_DATA to the folder of real data";
  const RobotModel robot = read_urdf(file).robot;
  const auto model = urdf::parseURDFFile(file.string());
  ASSERT_TRUE(model);
  ASSERT_EQ(model->links_.size(), robot.links.size());
  ForwardKinematics arm(robot);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const State state = random_state(robot, random);
    update(arm, state);
    const ByKdl kdl(*model, robot, state);
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      SCOPED_TRACE(robot.links[link].name);
      const KDL::Frame& frame = kdl.frame.at(robot.links[link].name);
      const KDL::Twist& twist = kdl.twist.at(robot.links[link].name);
      const Pose X_WL = arm.X_WL(link);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(X_WL.translation()[i], frame.p[i], 1e-9);
        EXPECT_NEAR(arm.w_WL(link)[i], twist.rot[i], 1e-9);
        EXPECT_NEAR(arm.v_WLo(link)[i], twist.vel[i], 1e-9);
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(X_WL.linear()(i, j), frame.M(i, j), 1e-9);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ForwardKinematics, RealArm, testing::Values(kinova, fanuc, omni));

TEST(ForwardKinematics, VelocitiesAreDerivativesOfPosesOnRandomTrees) {
  constexpr double step = 1e-5;  // [s]; central differences then err by about 1e-9
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const RobotModel robot = random_robot(random);
    const State now = random_state(robot, random);
    State before = now, after = now;
    for (std::size_t c = 0; c < now.q.size(); ++c) {
      before.q[c] -= step * now.qd[c];
      after.q[c] += step * now.qd[c];
    }
    ForwardKinematics arm(robot), was(robot), will(robot);
    update(arm, now);
    update(was, before);
    update(will, after);
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      const Vec3 v = (will.p_WL(link) - was.p_WL(link)) / (2 * step);
      EXPECT_LT((arm.v_WLo(link) - v).norm(), 1e-5 * (1 + v.norm())) << "link " << link;
      const Eigen::Matrix3d w_cross =
          (will.R_WL(link) - was.R_WL(link)) / (2 * step) * arm.R_WL(link).transpose();
      const Vec3 w(w_cross(2, 1), w_cross(0, 2), w_cross(1, 0));
      EXPECT_LT((arm.w_WL(link) - w).norm(), 1e-5 * (1 + w.norm())) << "link " << link;
    }
  }
}

TEST(ForwardKinematics, RotationsStayOrthonormalOnRandomTrees) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const RobotModel robot = random_robot(random);
    ForwardKinematics arm(robot);
    update(arm, random_state(robot, random));
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      const Eigen::Matrix3d R = arm.R_WL(link);
      EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-13);
      EXPECT_GT(R.determinant(), 0);
    }
  }
}

TEST(ForwardKinematics, JointTorquesAreTheTransposeOfTheVelocityMap) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const RobotModel robot = random_robot(random);
    const State state = random_state(robot, random);
    ForwardKinematics arm(robot);
    update(arm, state);
    std::vector<Wrench> wrenches;
    double power = 0, terms = 0;
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      wrenches.push_back({random_vector(random), random_vector(random)});
      const Wrench& wrench = wrenches.back();
      power += wrench.force.dot(arm.v_WLo(link)) + wrench.moment.dot(arm.w_WL(link));
      terms += wrench.force.norm() * arm.v_WLo(link).norm() +
               wrench.moment.norm() * arm.w_WL(link).norm();
    }
    std::vector<double> tau(robot.coordinates.size(), 1e300);
    arm.joint_torques(wrenches.data(), tau.data());
    double joint_power = 0;
    for (std::size_t c = 0; c < tau.size(); ++c) joint_power += tau[c] * state.qd[c];
    EXPECT_NEAR(joint_power, power, 1e-12 * terms);
  }
}

TEST(ForwardKinematics, WhatIsCarriedToTheBaseIsTheSumOfAllWrenches) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const RobotModel robot = random_robot(random);
    ForwardKinematics arm(robot);
    update(arm, random_state(robot, random));
    std::vector<Wrench> wrenches;
    Wrench sum;
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      wrenches.push_back({random_vector(random), random_vector(random)});
      sum.force += wrenches.back().force;
      sum.moment +=
          wrenches.back().moment + (arm.p_WL(link) - arm.p_WL(0)).cross(wrenches.back().force);
    }
    std::vector<double> tau(robot.coordinates.size());
    const Wrench carried = arm.joint_torques(wrenches.data(), tau.data());
    EXPECT_LT((carried.force - sum.force).norm(), 1e-12 * (1 + sum.force.norm()));
    EXPECT_LT((carried.moment - sum.moment).norm(), 1e-11 * (1 + sum.moment.norm()));
  }
}

TEST(ForwardKinematics, ATickTakesNoMemory) {
  std::mt19937_64 random(7);
  RobotModel robot;
  while (robot.coordinates.size() < 5) robot = random_robot(random);
  ForwardKinematics arm(robot);
  const State state = random_state(robot, random);
  const std::vector<Wrench> wrenches(robot.links.size(), {Vec3::Ones(), Vec3::Ones()});
  std::vector<double> tau(robot.coordinates.size());
  {
    NoAllocation guard;
    for (int tick = 0; tick < 100; ++tick) {
      update(arm, state);
      arm.joint_torques(wrenches.data(), tau.data());
    }
  }
  EXPECT_TRUE(std::isfinite(tau[0]));
}

TEST(ForwardKinematics, ARobotWithoutJointsOnlyFollowsItsBase) {
  RobotModel stone;
  stone.links.push_back({"stone", {}});
  ForwardKinematics arm(stone);
  const Pose X_WB = pose_from_rpy({1, 2, 3}, {0.1, 0.2, 0.3});
  arm.update(nullptr, nullptr, X_WB);
  EXPECT_LT((arm.X_WL(0).matrix() - X_WB.matrix()).norm(), 1e-15);
  const Wrench wrench{Vec3::UnitX(), Vec3::UnitZ()};
  EXPECT_EQ(arm.joint_torques(&wrench, nullptr).moment, Vec3(0, 0, 1));
}

TEST(ForwardKinematics, AModelThatBreaksItsPromisesIsRefused) {
  std::mt19937_64 random(3);
  RobotModel good;
  const auto a_turning = [](const Joint& joint) { return joint.type == JointType::revolute; };
  while (good.joints.empty() || !a_turning(good.joints[0])) good = random_robot(random);
  EXPECT_NO_THROW(ForwardKinematics{good});
  const auto refused = [&](const std::function<void(RobotModel&)>& spoil) {
    RobotModel bad = good;
    spoil(bad);
    EXPECT_THROW(ForwardKinematics{bad}, Error);
  };
  refused([](RobotModel& r) { r.links.clear(); });
  refused([](RobotModel& r) { r.links.push_back({"loose", {}}); });
  refused([](RobotModel& r) { r.joints[0].parent = 1; });
  refused([](RobotModel& r) { r.joints[0].parent = -1; });
  refused([](RobotModel& r) { r.joints[0].axis_J *= 2; });
  refused([](RobotModel& r) { r.joints[0].coordinate = 99; });
  refused([](RobotModel& r) { r.joints[0].multiplier = std::nan(""); });
  refused([](RobotModel& r) { r.coordinates[0] = 99; });
}

}  // namespace
}  // namespace vicinity
