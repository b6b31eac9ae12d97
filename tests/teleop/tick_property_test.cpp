// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A million and a half ticks of random arms in random fields, with random codings, memories,
// devices and hands: what must hold in every one of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "rounds.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/teleop/tick.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

constexpr double nominal_period = 0.001;
// Sanitizers make a tick ten times as long: there, fewer arms go through fewer ticks.
constexpr std::uint64_t strict_arms = test::rounds(20u), closing_arms = 5;  // in each group
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int ticks_each = 500, groups = 2;
#else
constexpr int ticks_each = 5000, groups = 10;
#endif

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double between(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(engine_); }
  Vec3 direction() {
    Vec3 v;
    do {
      v = Vec3(between(-1, 1), between(-1, 1), between(-1, 1));
    } while (v.norm() < 0.1 || v.norm() > 1);
    return v.normalized();
  }
  Pose pose(double reach) {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(between(-3, 3), direction()).toRotationMatrix();
    X.translation() = between(0, reach) * direction();
    return X;
  }

 private:
  std::mt19937_64 engine_;
};

// A tree of 1 to 8 joints that turn or slide, some of them mimics, with a bar on every link.
RobotModel random_arm(Random& random) {
  RobotModel robot;
  robot.name = "random arm";
  robot.links.push_back({"base", {}});
  const int joints = random.whole(1, 8);
  for (int n = 0; n < joints; ++n) {
    Joint joint;
    joint.name = "joint_" + std::to_string(n);
    joint.type = random.whole(0, 3) == 0 ? JointType::prismatic : JointType::continuous;
    joint.parent = random.whole(std::max(0, n - 1), n);
    joint.X_PJ = random.pose(0.3);
    joint.axis_J = random.direction();
    if (n > 0 && random.whole(0, 5) == 0) {
      joint.coordinate = random.whole(0, static_cast<int>(robot.coordinates.size()) - 1);
      joint.multiplier = random.between(-1, 1);
      joint.type = robot
                       .joints[static_cast<std::size_t>(
                           robot.coordinates[static_cast<std::size_t>(joint.coordinate)])]
                       .type;
    } else {
      joint.coordinate = static_cast<int>(robot.coordinates.size());
      robot.coordinates.push_back(n);
    }
    Link link{"link_" + std::to_string(n), {}};
    link.geometries.push_back(
        {LinkGeometry::Role::collision,
         primitive::box({random.between(0.02, 0.3), random.between(0.02, 0.1), 0.05})});
    robot.joints.push_back(joint);
    robot.links.push_back(link);
  }
  return robot;
}

ViscosityField random_field(Random& random) {
  Scene scene;
  scene.voxel_size = random.between(0.01, 0.03);
  const int objects = random.whole(1, 4);
  for (int n = 0; n < objects; ++n) {
    SceneObject object;
    object.name = "object_" + std::to_string(n);
    object.shape =
        random.whole(0, 1) == 0
            ? primitive::sphere(random.between(0.05, 0.2))
            : primitive::box({random.between(0.05, 0.4), 0.2, random.between(0.02, 0.4)});
    object.X_WO = random.pose(0.7);
    object.m = random.whole(1, 3);
    object.q = random.whole(1, 6);
    constexpr std::array shapes{LayerShape::sphere, LayerShape::cube, LayerShape::distance};
    object.layers = shapes[static_cast<std::size_t>(random.whole(0, 2))];
    object.coding.skin = random.between(50, 200);
    object.coding.mu.clear();
    double mu = random.between(10, 50);
    for (int rank = 0; rank < object.q; ++rank) {
      object.coding.mu.push_back(mu);
      mu *= random.between(0.5, 1);
    }
    scene.objects.push_back(object);
  }
  return build_field(scene, {.threads = 1, .progress = {}}).field;
}

TeleoperationOptions random_feel(Random& random) {
  constexpr std::array memories{"none", "sustained", "fading", "short", "rising"};
  TeleoperationOptions options;
  options.memory = named_memory(memories[static_cast<std::size_t>(random.whole(0, 4))]);
  options.direction = random.whole(0, 1) == 0 ? DragDirection::all : DragDirection::closing;
  options.traversal = random.whole(0, 2) == 0 ? Traversal::sampled : Traversal::swept;
  return options;
}

// Now smooth, now shaking with every tick, now at rest; the periods uneven at times. Velocities are
// those that the last two positions make.
//
// Or the cleverest that there is: all periods as long as may be, it goes where the last force
// pushes it, by steps that cost the device's own damping the same every time. The drag turns every
// such step round, so that the hand finds the direction in which there is most drag by itself, and
// gets the most out of it.
class Hand {
 public:
  /// @param damping  of the joints' axes, for a clever hand; empty: another one
  Hand(Random& random, std::size_t joints, const Eigen::VectorXd& damping)
      : random_(random), q_(joints), qd_(joints), home_(joints), drift_(joints), damping_(damping) {
    for (double& q : home_) q = random.between(-1.5, 1.5);
    for (double& r : rate_) r = random.between(0.2, 4);
  }

  Input next(const Output& last) {
    const bool clever = damping_.size() > 0;
    if (!clever && --left_ < 0) {
      left_ = random_.whole(50, 500);
      manner_ = random_.whole(0, 3);
      uneven_ = random_.whole(0, 1) == 1;
    }
    const double dt = clever    ? 1.4999 * nominal_period
                      : uneven_ ? random_.between(0.3, 1.49) * nominal_period
                                : nominal_period;
    t_ += dt;
    if (manner_ != 0) phase_ += dt;
    const double shake = manner_ == 2
                             ? (++turn_ % 2 == 0 ? 1e-4 : -1e-4) * std::sqrt(dt / nominal_period)
                         : manner_ == 3 ? random_.between(-1e-4, 1e-4)
                                        : 0;
    if (clever) follow(last);
    for (std::size_t c = 0; c < q_.size(); ++c) {
      const double q =
          home_[c] + 0.3 * std::sin(rate_[c % rate_.size()] * phase_) + drift_[c] + shake;
      qd_[c] = (q - q_[c]) / dt;
      q_[c] = q;
    }
    return {
        .time_s = t_, .q = q_.data(), .qd = qd_.data(), .joint_count = static_cast<int>(q_.size())};
  }

 private:
  void follow(const Output& last) {
    double cost = 0;
    for (std::size_t c = 0; c < q_.size(); ++c) {
      const auto axis = static_cast<Eigen::Index>(c);
      cost += last.torque[axis] * last.torque[axis] / damping_[axis];
    }
    for (std::size_t c = 0; c < q_.size(); ++c) {
      const auto axis = static_cast<Eigen::Index>(c);
      const double step = cost > 0 ? last.torque[axis] / damping_[axis] / std::sqrt(cost)
                                   : random_.between(-1, 1) / std::sqrt(damping_[axis]);
      drift_[c] += 1e-6 * step;
    }
  }

  Random& random_;
  std::vector<double> q_, qd_, home_, drift_;
  Eigen::VectorXd damping_;
  std::array<double, 8> rate_{};
  double t_ = 0, phase_ = 0;
  int left_ = 0, manner_ = 0;
  unsigned turn_ = 0;
  bool uneven_ = false;
};

// The power that torques put into a motion [W], and what rounding may make of none.
double power_into(const Input& input, const Output& output) {
  double power = 0;
  for (int c = 0; c < input.joint_count; ++c) power += output.torque[c] * input.qd[c];
  return power;
}
double rounding_of(const Input& input, const Output& output) {
  double size = 0;
  for (int c = 0; c < input.joint_count; ++c) size += std::abs(output.torque[c] * input.qd[c]);
  return 1e-9 * size;
}

class AnyArm : public testing::TestWithParam<int> {};

TEST_P(AnyArm, IsNeverFedByStrictDrag) {
  double taken = 0;
  int limited = 0;
  for (std::uint64_t n = 0; n < strict_arms; ++n) {
    const std::uint64_t seed = 100 * static_cast<std::uint64_t>(GetParam()) + n;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RobotModel robot = random_arm(random);
    const ViscosityField field = random_field(random);
    TeleoperationOptions options = random_feel(random);
    LimiterOptions limiter;
    limiter.axes = random.whole(0, 2) == 0 ? AxisKind::cartesian : AxisKind::joints;
    const auto axes = limiter.axes == AxisKind::cartesian
                          ? Eigen::Index{3}
                          : static_cast<Eigen::Index>(robot.coordinates.size());
    Eigen::VectorXd damping(axes);
    for (double& b : damping) b = std::pow(10.0, random.between(-4, 0));
    limiter.damping = damping.asDiagonal();
    if (random.whole(0, 4) == 0) limiter.force_limit = random.between(0.1, 10);
    options.limiter = limiter;
    Teleoperation teleoperation(robot, sample_body_points(robot, {.total = 60}), field, options);
    Hand hand(random, robot.coordinates.size(),
              n % 2 == 0 && limiter.axes == AxisKind::joints ? damping : Eigen::VectorXd());
    Output output;
    output.torque = AxisVector::Zero(static_cast<Eigen::Index>(robot.coordinates.size()));
    for (int k = 0; k < ticks_each; ++k) {
      const Input input = hand.next(output);
      const Status status = teleoperation.tick(input, output);
      ASSERT_TRUE(status == Status::ok || status == Status::started ||
                  status == Status::outside_field)
          << "tick " << k << ": " << to_string(status);
      ASSERT_TRUE(output.energy.passive) << "tick " << k << ": " << output.energy.lowest << " J";
      ASSERT_LE(power_into(input, output), rounding_of(input, output)) << "tick " << k;
      limited += output.limiter.limit != DragLimit::none ? 1 : 0;
    }
    taken += output.energy.drag;
  }
  EXPECT_GT(taken, 0);
  EXPECT_GT(limited, 0);
}

// The same hand moves two arms through the same field: what only opposes nearing never takes more
// power, and neither ever pushes.
TEST_P(AnyArm, FeelsNoMoreOfClosingThanOfAll) {
  double taken = 0;
  for (std::uint64_t n = 0; n < closing_arms; ++n) {
    const std::uint64_t seed = 100'000 + 100 * static_cast<std::uint64_t>(GetParam()) + n;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RobotModel robot = random_arm(random);
    const ViscosityField field = random_field(random);
    TeleoperationOptions options = random_feel(random);
    const BodyPoints points = sample_body_points(robot, {.total = 60});
    options.direction = DragDirection::all;
    Teleoperation all(robot, points, field, options);
    options.direction = DragDirection::closing;
    Teleoperation closing(robot, points, field, options);
    Hand hand(random, robot.coordinates.size(), {});
    Output of_all, of_closing;
    for (int k = 0; k < ticks_each; ++k) {
      const Input input = hand.next(of_all);
      (void)all.tick(input, of_all);
      (void)closing.tick(input, of_closing);
      if (k == 0) continue;  // started: no velocity yet
      ASSERT_LE(power_into(input, of_all), rounding_of(input, of_all)) << "tick " << k;
      ASSERT_LE(power_into(input, of_closing), rounding_of(input, of_closing)) << "tick " << k;
      ASSERT_LE(of_closing.power, of_all.power * (1 + 1e-6) + 1e-15) << "tick " << k;
      taken += of_closing.power;
    }
  }
  EXPECT_GT(taken, 0);
}

INSTANTIATE_TEST_SUITE_P(MillionTicks, AnyArm, testing::Range(0, groups));

}  // namespace
}  // namespace vicinity
