// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/tick.h"

#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "no_allocation.h"
#include "rounds.h"
#include "vicinity/drag/moving_point.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

constexpr double period = 0.001;

// An arm of four joints of three kinds, a mimic among them, about a metre long.
RobotModel small_arm() {
  RobotModel robot;
  robot.name = "small arm";
  robot.links.push_back({"base", {}});
  const auto add = [&](const char* name, JointType type, int parent, const Vec3& at,
                       const Vec3& axis, int coordinate, double multiplier, double length) {
    Joint joint;
    joint.name = std::string(name) + "_joint";
    joint.type = type;
    joint.parent = parent;
    joint.X_PJ.translation() = at;
    joint.axis_J = axis;
    joint.coordinate = coordinate;
    joint.multiplier = multiplier;
    Link link{name, {}};
    // No face of the arm lies on a face of the grid, where rounding alone would choose the voxel.
    TriangleMesh bar = primitive::box({length, 0.0613, 0.0613});
    for (Vec3& v : bar.vertices) v.x() += 0.5 * length;
    link.geometries.push_back({LinkGeometry::Role::collision, bar});
    robot.joints.push_back(joint);
    robot.links.push_back(link);
  };
  add("shoulder", JointType::continuous, 0, {0, 0, 0}, Vec3::UnitZ(), 0, 1, 0.4);
  add("elbow", JointType::revolute, 1, {0.4, 0, 0}, Vec3::UnitY(), 1, 1, 0.3);
  add("slide", JointType::prismatic, 2, {0.2, 0, 0}, Vec3::UnitX(), 2, 1, 0.3);
  add("finger", JointType::revolute, 3, {0.3, 0, 0}, Vec3::UnitZ(), 1, -0.5, 0.1);
  robot.coordinates = {0, 1, 2};
  robot.joints[1].limits.lower = -2;
  robot.joints[1].limits.upper = 2;
  return robot;
}

// Things around it, close enough that every motion meets some.
ViscosityField surroundings(LayerShape layers) {
  Scene scene;
  scene.voxel_size = 0.01;
  const auto place = [&](const char* name, TriangleMesh mesh, const Vec3& at) {
    SceneObject object;
    object.name = name;
    object.shape = std::move(mesh);
    object.X_WO.translation() = at;
    object.m = 2;
    object.layers = layers;
    scene.objects.push_back(object);
  };
  place("post", primitive::cylinder(0.08, 1.0), {0.5, 0.45, 0});
  place("ball", primitive::sphere(0.12), {0.1, -0.6, 0.2});
  place("slab", primitive::box({0.6, 0.6, 0.04}), {0.6, -0.2, -0.3});
  return build_field(scene, {.threads = 1, .progress = {}}).field;
}

const ViscosityField& ranked() {
  static const ViscosityField field = surroundings(LayerShape::sphere);
  return field;
}

BodyPoints points_of(const RobotModel& robot) {
  BodyPointOptions options;
  options.total = 700;
  return sample_body_points(robot, options);
}

// A smooth random motion of all joints.
struct Motion {
  explicit Motion(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int c = 0; c < 3; ++c) {
      centre[c] = c == 2 ? 0.1 * uniform(random) : uniform(random);
      size[c] = c == 2 ? 0.1 : 1.2;
      rate[c] = 1.5 + uniform(random);
      phase[c] = 3 * uniform(random);
    }
  }
  Vec3 at(double t) const {
    return (centre.array() + size.array() * (rate.array() * t + phase.array()).sin()).matrix();
  }
  Vec3 centre, size, rate, phase;
};

LimiterOptions strict_limiter(double damping) {
  LimiterOptions options;
  options.mode = LimiterMode::strict;
  options.axes = AxisKind::joints;
  options.damping = damping * Eigen::MatrixXd::Identity(3, 3);
  options.period_s = period * (1 + 1e-6);
  return options;
}

class FeltByEveryPoint
    : public testing::TestWithParam<std::tuple<const char*, DragDirection, LayerShape>> {};

// The plain way: every point of the arm on its own, and J'F by carrying each force down the tree.
TEST_P(FeltByEveryPoint, IsWhatTheJointsGet) {
  const auto& [memory, direction, layers] = GetParam();
  const RobotModel robot = small_arm();
  const BodyPoints points = points_of(robot);
  const ViscosityField field = layers == LayerShape::sphere ? ranked() : surroundings(layers);
  double felt_in_all = 0;
  for (std::uint64_t seed = 0; seed < test::rounds(6u); ++seed) {
    SCOPED_TRACE(seed);
    TeleoperationOptions options;
    options.memory = named_memory(memory);
    options.direction = direction;
    Teleoperation teleoperation(robot, points, field, options);
    ForwardKinematics kinematics(robot);
    std::vector<MovingPoint> plain(points.x.size());
    const Motion motion(seed);
    Output output;
    double felt = 0;
    for (int k = 0; k < 1500; ++k) {
      const double t = k * period;
      const Vec3 q = motion.at(t), qd = (motion.at(t + 1e-6) - motion.at(t - 1e-6)) / 2e-6;
      const Input input{.time_s = t, .q = q.data(), .qd = qd.data(), .joint_count = 3};
      const Status status = teleoperation.tick(input, output);
      ASSERT_TRUE(status == Status::ok || status == Status::beyond_joint_limits || k == 0)
          << to_string(status);

      kinematics.update(q.data(), qd.data(), Pose::Identity());
      std::vector<Wrench> wrenches(robot.links.size());
      for (const BodyPoints::LinkRange& range : points.links) {
        const auto link = static_cast<std::size_t>(range.link);
        for (std::uint32_t p = range.begin; p < range.end; ++p) {
          const Vec3 r = kinematics.R_WL(link) * Vec3(points.x[p], points.y[p], points.z[p]);
          const double mu_e =
              plain[p].advance(field, options.memory, Traversal::swept, kinematics.p_WL(link) + r);
          const Vec3 v = kinematics.v_WLo(link) + kinematics.w_WL(link).cross(r);
          const Vec3 F = direction == DragDirection::all
                             ? drag_force(mu_e, points.area[p], v)
                             : closing_drag_force(
                                   mu_e, points.area[p], v,
                                   mu_e > 0 ? plain[p].towards_surface(field) : Vec3(Vec3::Zero()));
          wrenches[link].force += F;
          wrenches[link].moment += r.cross(F);
          if (k == 0) continue;
          const PointDrag felt_there = teleoperation.point_drag(p);
          ASSERT_NEAR(felt_there.mu_e, mu_e, 1e-6 * mu_e) << "tick " << k << ", point " << p;
          ASSERT_LT((felt_there.force_W - F).norm(), 1e-5 * F.norm() + 1e-9)
              << "tick " << k << ", point " << p;
        }
      }
      Vec3 tau;
      kinematics.joint_torques(wrenches.data(), tau.data());
      if (k == 0) continue;  // no velocity yet: no drag
      ASSERT_LT((output.torque - tau).norm(), 1e-5 * tau.norm() + 1e-9) << "tick " << k;
      ASSERT_LE(output.torque.dot(qd), 0);
      felt += tau.norm();
    }
    felt_in_all += felt;
  }
  EXPECT_GT(felt_in_all, 0) << "the motions met nothing";
}

INSTANTIATE_TEST_SUITE_P(
    Tick, FeltByEveryPoint,
    testing::Values(std::tuple{"none", DragDirection::all, LayerShape::sphere},
                    std::tuple{"fading", DragDirection::all, LayerShape::sphere},
                    std::tuple{"rising", DragDirection::closing, LayerShape::sphere},
                    std::tuple{"none", DragDirection::all, LayerShape::distance}));

TEST(Tick, TakesNoMemory) {
  const RobotModel robot = small_arm();
  TeleoperationOptions options;
  options.memory = named_memory("sustained");
  options.limiter = strict_limiter(0.5);
  Teleoperation teleoperation(robot, points_of(robot), ranked(), options);
  const Motion motion(3);
  Output output;
  std::uint32_t felt = 0;
  {
    const NoAllocation guard;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 q = motion.at(k * period);
      const Input input{.time_s = k * period, .q = q.data(), .joint_count = 3};
      const Status status = teleoperation.tick(input, output);
      felt += status == Status::ok ? output.counts.points_felt : 0;
    }
  }
  EXPECT_GT(felt, 0u);
}

// In a process that the kernel kills at its first system call but the one that ends it.
TEST(Tick, MakesNoSystemCall) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer has a thread of its own, which makes system calls";
#endif
  const RobotModel robot = small_arm();
  TeleoperationOptions options;
  options.memory = named_memory("fading");
  options.limiter = strict_limiter(0.5);
  Teleoperation teleoperation(robot, points_of(robot), ranked(), options);
  teleoperation.swap_field(ranked());
  const Motion motion(3);
  Output output;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    constexpr int refused = 77;
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) _exit(refused);
    std::uint32_t felt = 0;
    for (int k = 0; k < 3000; ++k) {
      Vec3 q = motion.at(k * period);
      if (k % 500 == 499) q.x() = std::numeric_limits<double>::quiet_NaN();
      Input input{.time_s = k * period, .q = q.data(), .joint_count = 3};
      if (k % 700 == 699) input.X_WB.translation().x() += 0.5;  // a jump
      (void)teleoperation.tick(input, output);
      felt += output.counts.points_felt;
    }
    syscall(SYS_exit, felt > 0 && output.counts.fields_taken == 1 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "this kernel has no seccomp";
  ASSERT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0) << "nothing was felt, or the field was not taken";
}

// A joint beyond its limits is said, and feels as ever.
TEST(Tick, SaysWhenAJointIsBeyondItsLimits) {
  RobotModel robot = small_arm();
  Teleoperation without(robot, points_of(robot), ranked(), {});
  robot.joints[1].limits.upper = 0.1;
  Teleoperation with(robot, points_of(robot), ranked(), {});
  const Motion motion(2);
  Output expected, output;
  int beyond = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 q = motion.at(k * period);
    const Input input{.time_s = k * period, .q = q.data(), .joint_count = 3};
    (void)without.tick(input, expected);
    const Status status = with.tick(input, output);
    if (k == 0) continue;
    ASSERT_EQ(status == Status::beyond_joint_limits, q[1] > 0.101) << "q " << q[1];
    ASSERT_EQ(output.torque, expected.torque);
    beyond += status == Status::beyond_joint_limits ? 1 : 0;
  }
  EXPECT_GT(beyond, 0);
}

// How many points there are does not matter: each carries its share of the surface.
TEST(Tick, FeelsTheSameWithTwoThousandAndFiftyThousandPoints) {
  const RobotModel robot = small_arm();
  Teleoperation few(robot, sample_body_points(robot, {.total = 2000}), ranked(), {});
  Teleoperation many(robot, sample_body_points(robot, {.total = 50'000}), ranked(), {});
  for (std::uint64_t seed = 0; seed < test::rounds(4u); ++seed) {
    SCOPED_TRACE(seed);
    const Motion motion(seed);
    Output of_few, of_many;
    double work_of_few = 0, work_of_many = 0;
    for (int k = 0; k < 1000; ++k) {
      const double t = 10. * static_cast<double>(seed) + k * period;
      const Vec3 q = motion.at(k * period);
      const Input input{.time_s = t, .q = q.data(), .joint_count = 3};
      (void)few.tick(input, of_few);
      (void)many.tick(input, of_many);
      work_of_few += of_few.power * period;
      work_of_many += of_many.power * period;
    }
    EXPECT_GT(work_of_many, 0);
    EXPECT_NEAR(work_of_few / work_of_many, 1, 0.02);
    RecordProperty("few_to_many_" + std::to_string(seed),
                   std::to_string(work_of_few / work_of_many));
  }
}

TEST(Tick, StrictNeverFeedsTheMotion) {
  const RobotModel robot = small_arm();
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    TeleoperationOptions options;
    options.memory = named_memory(seed % 2 == 0 ? "none" : "short");
    options.direction = seed % 4 < 2 ? DragDirection::all : DragDirection::closing;
    options.limiter = strict_limiter(0.05);
    Teleoperation teleoperation(robot, points_of(robot), ranked(), options);
    const Motion motion(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> shake(-2e-5, 2e-5);
    Output output;
    bool limited = false;
    for (int k = 0; k < 5000; ++k) {
      const Vec3 q = motion.at(k * period) + Vec3(shake(random), shake(random), shake(random));
      const Input input{.time_s = k * period, .q = q.data(), .joint_count = 3};
      (void)teleoperation.tick(input, output);
      ASSERT_TRUE(output.energy.passive) << "tick " << k;
      ASSERT_GE(output.power, 0);
      limited |= output.limiter.limit == DragLimit::damping;
    }
    EXPECT_TRUE(limited) << "the limiter had nothing to do";
    EXPECT_GT(output.energy.drag, 0);
  }
}

// What gets most out of sampled drag: the hand turns round with every tick, so that each force
// pushes along, while the periods are as uneven as may be.
TEST(Tick, StrictBearsAHandThatTurnsWithEveryUnevenPeriod) {
  const RobotModel robot = small_arm();
  for (const AxisKind axes : {AxisKind::joints, AxisKind::cartesian}) {
    int limited = 0;
    for (std::uint64_t seed = 0; seed < test::rounds(12u); ++seed) {
      SCOPED_TRACE(std::string(axes == AxisKind::joints ? "joints" : "cartesian") + ", seed " +
                   std::to_string(seed));
      TeleoperationOptions options;
      options.limiter = strict_limiter(axes == AxisKind::joints ? 0.001 : 0.005);
      options.limiter->axes = axes;
      options.limiter->ramp_s = period;
      Teleoperation teleoperation(robot, points_of(robot), ranked(), options);
      const Motion motion(seed);
      std::mt19937_64 random(seed);
      Output output;
      double t = 0;
      for (int k = 0; k < 4000; ++k) {
        const double dt = random() % 2 == 0 ? period : 1.5 * period * (1 - 1e-9);
        t += dt;
        // Slow on the whole, so that the turns make the velocity.
        const Vec3 turn = (k % 2 == 0 ? 1 : -1) * std::sqrt(dt / period) * Vec3(4e-4, 3e-4, 2e-4);
        const Vec3 q = motion.at(0.02 * t) + turn;
        const Input input{.time_s = t, .q = q.data(), .joint_count = 3};
        (void)teleoperation.tick(input, output);
        ASSERT_TRUE(output.energy.passive) << "tick " << k << ": " << output.energy.lowest << " J";
        limited += output.limiter.limit == DragLimit::damping ? 1 : 0;
      }
    }
    EXPECT_GT(limited, test::rounds(10000));
  }
}

// The sharp case: one axis, short and long periods in turn, steps such that each force made in a
// short period pushes through a long one. A limiter that took the short one for T would need 1.02
// of the damping that there is.
TEST(Tick, StrictBearsTheWorstOfUnevenPeriods) {
  RobotModel robot;
  robot.name = "slide";
  TriangleMesh bar = primitive::box({0.3, 0.0613, 0.0613});
  robot.links = {{"base", {}}, {"bar", {{LinkGeometry::Role::collision, bar}}}};
  Joint slide;
  slide.name = "slide_joint";
  slide.type = JointType::prismatic;
  slide.parent = 0;
  slide.axis_J = Vec3::UnitX();
  slide.coordinate = 0;
  robot.joints = {slide};
  robot.coordinates = {0};
  for (const AxisKind axes : {AxisKind::joints, AxisKind::cartesian}) {
    TeleoperationOptions options;
    options.limiter = strict_limiter(0.001);
    options.limiter->axes = axes;
    options.limiter->damping = 0.001 * Eigen::MatrixXd::Identity(axes == AxisKind::joints ? 1 : 3,
                                                                 axes == AxisKind::joints ? 1 : 3);
    options.limiter->ramp_s = period;
    Teleoperation teleoperation(robot, points_of(robot), ranked(), options);
    Output output;
    double t = 0, q = 0;
    int limited = 0;
    for (int k = 0; k < 4000; ++k) {
      const double dt = k % 2 == 0 ? period : 1.5 * period * (1 - 1e-9);
      t += dt;
      q += (k % 2 == 0 ? 1 : -1) * 1e-5 * std::sqrt(dt / period);
      Input input{.time_s = t, .q = &q, .joint_count = 1};
      input.X_WB.translation() = Vec3(0.5, -0.2, -0.25);  // just above the slab
      (void)teleoperation.tick(input, output);
      ASSERT_TRUE(output.energy.passive) << "tick " << k << ": " << output.energy.lowest << " J";
      limited += output.limiter.limit == DragLimit::damping ? 1 : 0;
    }
    EXPECT_GT(limited, 3990);
  }
}

TEST(Tick, NamesBadInputGivesNoForceAndRecovers) {
  const RobotModel robot = small_arm();
  TeleoperationOptions options;
  options.limiter = strict_limiter(0.5);
  options.limiter->ramp_s = 0.01;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Bad {
    const char* name;
    Status expected;
    void (*spoil)(Input&, Vec3&);
  };
  static const double not_a_number = nan;
  const Bad cases[] = {
      {"NaN position", Status::not_finite, [](Input&, Vec3& q) { q[1] = not_a_number; }},
      {"infinite time", Status::not_finite,
       [](Input& in, Vec3&) { in.time_s = std::numeric_limits<double>::infinity(); }},
      {"wrong size", Status::wrong_size, [](Input& in, Vec3&) { in.joint_count = 2; }},
      {"no positions", Status::wrong_size, [](Input& in, Vec3&) { in.q = nullptr; }},
      {"time standing still", Status::time_stood_still,
       [](Input& in, Vec3&) { in.time_s -= period; }},
      {"time running backwards", Status::time_ran_backwards,
       [](Input& in, Vec3&) { in.time_s -= 0.5; }},
      {"missed deadline", Status::deadline_missed, [](Input& in, Vec3&) { in.time_s += 0.02; }},
      {"positions too far apart for a velocity", Status::not_finite,
       [](Input&, Vec3& q) { q[0] = 3e305; }},
      {"half a turn at once", Status::jumped, [](Input&, Vec3& q) { q[0] += 3; }},
      {"half a metre at once", Status::jumped,
       [](Input& in, Vec3&) { in.X_WB.translation().x() += 0.5; }},
  };
  for (const Bad& bad : cases) {
    SCOPED_TRACE(bad.name);
    Teleoperation teleoperation(robot, points_of(robot), ranked(), options);
    const Motion motion(1);
    Output output;
    double shift = 0;
    for (int k = 0; k < 400; ++k) {
      Vec3 q = motion.at(k * period);
      Input input{.time_s = k * period + shift, .q = q.data(), .joint_count = 3};
      if (k == 200) {
        bad.spoil(input, q);
        if (bad.expected == Status::time_ran_backwards) shift = -0.5;
        if (bad.expected == Status::deadline_missed) shift = 0.02;
        EXPECT_EQ(teleoperation.tick(input, output), bad.expected) << to_string(output.status);
        EXPECT_EQ(output.torque.norm(), 0);
        EXPECT_EQ(output.torque.size(), 3);
        continue;
      }
      const Status status = teleoperation.tick(input, output);
      EXPECT_TRUE(output.torque.allFinite());
      if (k > 210) {
        EXPECT_TRUE(status == Status::ok || status == Status::outside_field) << to_string(status);
        EXPECT_NEAR(output.limiter.ramp, 1, 1e-12);
      }
    }
  }
}

// The last link's origin lies on its own axis, and stays where it is.
TEST(Tick, ALeapAboutALinksOwnAxisIsNoMotion) {
  RobotModel robot = small_arm();
  robot.links.resize(2);
  robot.joints.resize(1);
  robot.coordinates = {0};
  TeleoperationOptions options;
  Teleoperation teleoperation(robot, points_of(robot), ranked(), options);
  Output output;
  double q = 0, time_s = 0;
  const auto tick = [&] {
    time_s += period;
    return teleoperation.tick({.time_s = time_s, .q = &q, .joint_count = 1}, output);
  };
  tick();
  // The link is 0.4 m long: its corners are 0.401 m from the axis.
  for (const double turn : {0.2, 0.24, -0.24, -0.2}) {
    q += turn;
    EXPECT_LE(tick(), Status::outside_field) << turn;
  }
  for (const double turn : {0.3, 1.0, 3.1, -3.1, -0.3}) {
    q += turn;
    EXPECT_EQ(tick(), Status::jumped) << turn;
    EXPECT_EQ(output.torque.norm(), 0);
    EXPECT_LE(tick(), Status::outside_field);
  }
}

TEST(Tick, RefusesPointsOfAnotherRobotAndWeightsThatAreNone) {
  const RobotModel robot = small_arm();
  RobotModel shorter = robot;
  shorter.links.resize(2);
  shorter.joints.resize(1);
  shorter.coordinates = {0};
  EXPECT_THROW(Teleoperation(shorter, points_of(robot), ranked()), Error);
  TeleoperationOptions options;
  for (const MemoryWeights& none :
       {MemoryWeights{.k = 0}, MemoryWeights{.k = 33}, MemoryWeights{.k = 1, .alpha = {0}},
        MemoryWeights{.k = 2, .alpha = {1, -1}},
        MemoryWeights{.k = 1, .alpha = {std::numeric_limits<double>::infinity()}}}) {
    options.memory = none;
    EXPECT_THROW(Teleoperation(robot, points_of(robot), ranked(), options), Error) << none.k;
  }
}

TEST(Tick, SaysWhichPointObjectAndRankItWas) {
  const RobotModel robot = small_arm();
  const BodyPoints points = points_of(robot);
  Teleoperation teleoperation(robot, points, ranked(), {});
  const Motion motion(2);
  Output output;
  int said = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 q = motion.at(k * period);
    const Input input{.time_s = k * period, .q = q.data(), .joint_count = 3};
    if (teleoperation.tick(input, output) != Status::ok || output.reason.object < 0) continue;
    ++said;
    const Reason& reason = output.reason;
    ASSERT_LT(static_cast<std::size_t>(reason.point), points.x.size());
    ASSERT_GT(reason.share, 0);
    ASSERT_LE(reason.share, 1 + 1e-12);
    ASSERT_LT(static_cast<std::size_t>(reason.object), ranked().objects().size());
    if (reason.kind == VoxelKind::neighbour) {
      ASSERT_GE(reason.rank, 1);
    }
  }
  EXPECT_GT(said, 0);
}

TEST(Tick, OutsideTheFieldFeelsNothingAndSaysSo) {
  const RobotModel robot = small_arm();
  Teleoperation teleoperation(robot, points_of(robot), ranked(), {});
  const Motion motion(2);
  Output output;
  for (int k = 0; k < 10; ++k) {
    const Vec3 q = motion.at(k * period);
    Input input{.time_s = k * period, .q = q.data(), .joint_count = 3};
    input.X_WB.translation().z() = 40;
    const Status status = teleoperation.tick(input, output);
    EXPECT_EQ(status, k == 0 ? Status::started : Status::outside_field);
    EXPECT_EQ(output.torque.norm(), 0);
    EXPECT_EQ(output.counts.points_looked, 0u);
  }
}

TEST(Tick, TakesAnotherFieldWholeWhileItRuns) {
  const RobotModel robot = small_arm();
  Teleoperation teleoperation(robot, points_of(robot), ranked(), {});
  const std::vector<Coding> twice(3, Coding{{64, 50, 40, 34, 30, 26}, 200});
  const ViscosityField other = ranked().with_codings(twice);
  std::atomic<bool> done{false};
  std::thread swapper([&] {
    for (int n = 0; !done; ++n) {
      teleoperation.swap_field(n % 2 == 0 ? other : ranked());
      if (n > 20) std::this_thread::sleep_for(std::chrono::milliseconds(10));  // then at 100 Hz
    }
  });
  // Two more, never swapped: what comes out must be one or the other, never between.
  Teleoperation once(robot, points_of(robot), ranked(), {}),
      doubled(robot, points_of(robot), other, {});
  const Motion motion(4);
  Output output, single, two;
  std::uint64_t taken = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 q = motion.at(k * period);
    const Input input{.time_s = k * period, .q = q.data(), .joint_count = 3};
    (void)teleoperation.tick(input, output);
    (void)once.tick(input, single);
    (void)doubled.tick(input, two);
    const double slack = 1e-6 * two.torque.norm();
    ASSERT_TRUE((output.torque - single.torque).norm() <= slack ||
                (output.torque - two.torque).norm() <= slack)
        << "tick " << k << ": " << output.torque.transpose() << " is neither "
        << single.torque.transpose() << " nor " << two.torque.transpose();
    taken = output.counts.fields_taken;
  }
  done = true;
  swapper.join();
  EXPECT_GT(taken, 1u);
}

}  // namespace
}  // namespace vicinity
