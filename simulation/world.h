// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The slave and its workplace in motion: MuJoCo makes the dynamics, the contacts and the impacts.
#pragma once

#include <cstdint>
#include <memory>

#include "simulation/arm_model.h"
#include "simulation/voxel_boxes.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/teleop/axes.h"

namespace vicinity {

struct WorldOptions {
  Pose X_WB = Pose::Identity();  ///< the robot's base
  /// Of the physics and of the slave's servo. Up to 5 ms: beyond, an arm that meets metal gains
  /// energy from the integration.
  double step_s = 0.002;
  /// Servo: M(q) (w² e + 2 z w e') + bias, each joint as a damped spring about where it is led to.
  /// A position loop of an industrial arm has a bandwidth of some 5 to 10 Hz.
  double servo_frequency_hz = 8;
  double servo_damping = 0.9;  ///< z, relative to critical
  double gravity = 9.81;       ///< along -z of W [m/s²]
};

/// What touches, at one instant.
struct Contacts {
  int count = 0;
  double force = 0;          ///< sum of the normal forces                      [N]
  double closing_speed = 0;  ///< of the fastest, along its normal, before the contact pushes [m/s]
  Vec3 force_W = Vec3::Zero();  ///< on the arm, in W                           [N]
};

/// One arm among boxes. Only boxes near the arm are in the model at a time, so that the cost does
/// not grow with the workplace. Not for two threads at once; same input, same motion, to the bit.
class World {
 public:
  /// @param boxes  shared among worlds
  /// Errors: throws Error for an arm without inertia, a step that is no positive time up to 5 ms,
  /// and what MuJoCo refuses.
  World(const RobotModel& robot, std::shared_ptr<const VoxelBoxes> boxes,
        const WorldOptions& options = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  double step_s() const noexcept;

  /// At rest at q. @param q  shape (coordinates,) [rad or m]
  void start(const AxisVector& q);

  /// One step towards where the joints are led to, and on with the velocity they are led with.
  /// @return  false where the numbers have blown up: the world is as it was before, and at rest
  bool step(const AxisVector& q_led, const AxisVector& qd_led);

  /// Joint positions and the servo's torque but for gravity and Coriolis: inertia, friction,
  /// contact (tau2 of eq. 10), shape (coordinates,) [rad or m], [N·m or N].
  const AxisVector& q() const noexcept { return q_; }
  const AxisVector& tau2() const noexcept { return tau2_; }
  const Contacts& contacts() const noexcept { return contacts_; }

  /// Pose of a link by MuJoCo's own kinematics.
  Pose X_WL(std::size_t link) const;
  /// Free fall: the servo is off from now on. For checks.
  void let_go() noexcept { servo_on_ = false; }

 private:
  struct Physics;

  void bring_boxes();
  void look_at_contacts();
  void read_joints();

  std::unique_ptr<Physics> physics_;
  std::shared_ptr<const VoxelBoxes> boxes_;
  double stiffness_, damping_;
  AxisVector q_, tau2_;
  Contacts contacts_;
  bool servo_on_ = true;
  std::uint64_t steps_ = 0;
};

}  // namespace vicinity
