// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The tick: joint angles in, drag on the whole arm out.
///
///   Input   q, qd or none, time, base
///     | hear            refuse what no arm could have sent; velocities from positions
///     | move            kinematics: poses and velocities of all links
///     | feel            every body point: voxels on its path -> mu_e (eq. 6-7)
///     | carry           mu_e S of all points -> one 6 x 6 drag a link -> D of the joints (eq. 5)
///     | limit           s D, so that the device stays passive
///     | account         the exact energy audit
///   Output  torques, force at the tool, master force (eq. 8-10), the reason, status
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "vicinity/drag/drag.h"
#include "vicinity/drag/moving_point.h"
#include "vicinity/drag/viscosity_memory.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/teleop/energy_audit.h"
#include "vicinity/teleop/handover.h"
#include "vicinity/teleop/limiter.h"
#include "vicinity/teleop/master_force.h"
#include "vicinity/teleop/velocity_estimator.h"
#include "vicinity/viscosity/field.h"

namespace vicinity {

class TreeDrag;

/// What became of a tick. From `deadline_missed` on, the force is zero. With a limiter, what
/// follows grows back over LimiterOptions::ramp_s: a sudden drop is felt, and so is a sudden
/// return. Without one it is back at once.
enum class Status : std::uint8_t {
  ok,
  started,              ///< the first tick: velocity zero, no drag
  beyond_joint_limits,  ///< a joint is outside its limits; drag as usual
  outside_field,        ///< no body point is in the workspace; there is nothing to feel
  deadline_missed,      ///< more than `longest_period_s` since the last tick
  time_stood_still,     ///< the time stamp is the last one's: a stale joint state
  time_ran_backwards,
  not_finite,   ///< NaN or infinity among positions, velocities, time or base
  wrong_size,   ///< not as many joints as the robot has
  jumped,       ///< a point may have moved by more than `longest_jump_m`; all points start anew
  not_passive,  ///< the limiter refused: see Output::limiter.status
};

/// "ok", "started", ...
const char* to_string(Status status) noexcept;

/// How the arm feels. Fixed for the life of a Teleoperation.
struct TeleoperationOptions {
  MemoryWeights memory;
  DragDirection direction = DragDirection::all;
  Traversal traversal = Traversal::swept;
  /// The device that renders the drag. Joints: one axis for each coordinate of the robot.
  /// Cartesian: the device's handle leads the tool. Absent: the drag is given as the field has it,
  /// and nothing is promised about stability. Its period_s is raised to `longest_period_s`: what
  /// still counts as on time decides how much drag is passive.
  std::optional<LimiterOptions> limiter;
  /// How velocities are found where the input has none. In `strict` mode always, from the last two
  /// positions of the device's own axes, its joints or its handle: the proof is about those.
  double velocity_window_s = 0.004;
  double noise_band = 0;  ///< half-width, all joints [rad or m]
  MasterArm master;
  int tool_link = -1;  ///< link whose origin the tool's force is about; -1: the last one
  /// Beyond: the deadline was missed. No torque may act for longer, so whoever sends it to the
  /// device sends zero by then. The audit assumes the worst: that the last torque was held.
  double longest_period_s = 0.0015;
  /// By any point of a link in one tick; farther is no motion. Where voxels are small, 510 of them.
  double longest_jump_m = 0.1;
};

/// For whoever has a robot before he has a field. Errors: throws Error for options that do not fit
/// the robot.
void check_fit(const RobotModel& robot, const TeleoperationOptions& options);

/// One joint state.
struct Input {
  double time_s = 0;
  const double* q = nullptr;   ///< joint positions, shape (joint_count,) [rad or m]
  const double* qd = nullptr;  ///< joint velocities, same shape, or null: they are differenced
  int joint_count = 0;
  Pose X_WB = Pose::Identity();  ///< the robot's base
  double tau2 = 0;               ///< the slave's own torque of eq. 10 [N·m]
};

/// The point that contributed most, and why.
struct Reason {
  int point = -1;   ///< index into BodyPoints; -1: nothing is felt
  int link = -1;    ///< as in RobotModel
  int object = -1;  ///< as in ViscosityField::objects(); -1: only remembered, the point has left
  VoxelKind kind = VoxelKind::empty;
  int rank = 0;
  double share = 0;              ///< of the power that all points take out, 0..1
  double distance_m = 0;         ///< at least this far from the surface [m]
  double time_to_contact_s = 0;  ///< at this speed, at the earliest [s]
};

struct Counts {
  std::uint64_t ticks = 0, refused = 0, missed_deadlines = 0, fields_taken = 0;
  std::uint32_t points_felt = 0;    ///< in this tick: points with drag
  std::uint32_t points_looked = 0;  ///< in this tick: points that were not skipped as far away
};

/// What one body point felt in a tick: eq. 5, before the limiter.
struct PointDrag {
  double mu_e = 0;              ///< effective viscosity [N·s/m³]
  Vec3 force_W = Vec3::Zero();  ///< on the point, in W, shape (3,) [N]
};

struct Output {
  Status status = Status::ok;
  AxisVector torque;        ///< on the joints: -s D qd, shape (joint_count,) [N·m or N]
  Wrench tool;              ///< all drag, as given, about the tool link's origin, in W [N], [N·m]
  AxisVector device_force;  ///< in the axes of the limiter; the joints' where there is none
  double master_force = 0;  ///< third term of eq. 10 [N]
  double power = 0;         ///< taken out of the motion, >= 0 [W]
  Reason reason;
  LimiterOutput limiter;  ///< the mode's cost: what was asked, what was given, and the limit
  EnergyBalance energy;
  Counts counts;
};

/// One arm in one field. tick() belongs to one thread; swap_field() may be called from another.
class Teleoperation {
 public:
  /// Takes all memory. Errors: as check_fit().
  Teleoperation(const RobotModel& robot, BodyPoints points, const ViscosityField& field,
                const TeleoperationOptions& options = {});
  ~Teleoperation();
  Teleoperation(const Teleoperation&) = delete;
  Teleoperation& operator=(const Teleoperation&) = delete;

  int joint_count() const noexcept;
  const BodyPoints& points() const noexcept;

  /// What a point felt in the last tick that was not refused. For the tick's own thread, between
  /// two ticks. @param point  index into points(), less than points().x.size() Real-time: no
  /// allocation.
  PointDrag point_drag(std::uint32_t point) const noexcept;

  /// One period. `output` is written whole whatever happens; its torque is zero, and safe, for
  /// every status from `deadline_missed` on. Real-time: time in links, in clusters of points that
  /// may be near something, and in their points; no allocation, lock, system call or exception.
  [[nodiscard]] Status tick(const Input& input, Output& output) noexcept;

  /// Forgets all that was: the next tick is the first one, and the audit and the counts begin anew.
  /// Not while another thread ticks.
  void restart() noexcept;

  /// Puts another field, or the same with other codings, in place of this one from the next tick
  /// on. The tick takes it whole or not at all, and never waits. Not for the tick's own thread:
  /// prepares the field (milliseconds) and frees the one that was given up before. One caller at a
  /// time.
  void swap_field(const ViscosityField& field);

 private:
  class Body;
  struct FieldView;

  void take_new_field() noexcept;
  Status hear(const Input& input) noexcept;
  bool move(const Input& input) noexcept;
  void carry(Output& output) noexcept;
  Status limit(const Input& input, Status heard, Output& output) noexcept;
  void account(const Input& input, Output& output) noexcept;
  AxisMatrix tool_map() const noexcept;
  Status rest(Status status, const Input& input, Output& output) noexcept;

  TeleoperationOptions options_;
  RobotModel robot_;
  ForwardKinematics kinematics_;
  VelocityEstimator velocity_, handle_velocity_;
  std::optional<DragLimiter> limiter_;
  EnergyAudit audit_;
  std::unique_ptr<Body> body_;
  std::unique_ptr<TreeDrag> tree_;
  AxisVector q_, qd_;
  AxisMatrix drag_;
  double last_time_s_ = 0;
  bool started_ = false;
  Counts counts_;

  // The field in use belongs to the tick's thread; others change hands whole.
  std::unique_ptr<FieldView> view_;
  Handover<FieldView> views_;
};

}  // namespace vicinity
