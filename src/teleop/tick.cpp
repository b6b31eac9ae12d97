// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/tick.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "body.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

// A controller's position may overshoot a limit by this much without being wrong [rad or m].
constexpr double limit_slack = 1e-3;
// Square of the lever below which a direction counts as singular [m²].
constexpr double singular_slack = 1e-6;
// A window that holds two samples and no more, however fast they come [s].
constexpr double plain_difference = 1e-9;

Eigen::Index axes_of(const RobotModel& robot) {
  return static_cast<Eigen::Index>(robot.coordinates.size());
}

bool strict(const TeleoperationOptions& options) noexcept {
  return options.limiter && options.limiter->mode == LimiterMode::strict;
}

bool cartesian(const TeleoperationOptions& options) noexcept {
  return options.limiter && options.limiter->axes == AxisKind::cartesian;
}

// Only `strict` states what the device really damps; without it the account is of the drag alone.
Eigen::MatrixXd audited_damping(const RobotModel& robot, const TeleoperationOptions& options) {
  if (strict(options)) return options.limiter->damping;
  const Eigen::Index n = cartesian(options) ? 3 : axes_of(robot);
  return Eigen::MatrixXd::Zero(n, n);
}

Eigen::Index checked_axes(const RobotModel& robot) {
  const Eigen::Index n = axes_of(robot);
  if (n < 1 || n > axis_capacity) {
    throw Error({.where = "robot '" + robot.name + "'",
                 .what = "not an arm that the tick can move",
                 .found = std::to_string(n) + " joints that move",
                 .expected = "1 to " + std::to_string(axis_capacity)});
  }
  return n;
}

BodyPoints of_robot(BodyPoints points, const RobotModel& robot) {
  for (const BodyPoints::LinkRange& range : points.links) {
    if (range.link >= 0 && static_cast<std::size_t>(range.link) < robot.links.size()) continue;
    throw Error({.where = "body points",
                 .what = "they are those of another robot",
                 .found = "points of link " + std::to_string(range.link),
                 .expected = "links of '" + robot.name + "', which has " +
                             std::to_string(robot.links.size())});
  }
  return points;
}

void check_positive(const char* what, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw Error({.where = what, .what = "is not a positive number", .found = std::to_string(value)});
}

DragLimiter limiter_for(const RobotModel& robot, const TeleoperationOptions& options) {
  LimiterOptions limits = *options.limiter;
  limits.period_s = std::max(limits.period_s, options.longest_period_s);
  DragLimiter limiter(limits);
  if (limits.axes == AxisKind::joints && limiter.axis_count() != axes_of(robot)) {
    throw Error({.where = "limiter",
                 .what = "it is for another arm",
                 .found = std::to_string(limiter.axis_count()) + " axes",
                 .expected = std::to_string(axes_of(robot)) + ", one for each joint of '" +
                             robot.name + "'"});
  }
  return limiter;
}

}  // namespace

void check_fit(const RobotModel& robot, const TeleoperationOptions& options) {
  checked_axes(robot);
  checked(options.master);
  check_positive("longest_period_s", options.longest_period_s);
  check_positive("longest_jump_m", options.longest_jump_m);
  if (options.limiter) (void)limiter_for(robot, options);
  const int links = static_cast<int>(robot.links.size());
  if (options.tool_link >= links) {
    throw Error({.where = "tool_link",
                 .what = "no such link",
                 .found = std::to_string(options.tool_link),
                 .expected = "less than " + std::to_string(links)});
  }
}

const char* to_string(Status status) noexcept {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::started:
      return "started";
    case Status::beyond_joint_limits:
      return "beyond joint limits";
    case Status::outside_field:
      return "outside field";
    case Status::deadline_missed:
      return "deadline missed";
    case Status::time_stood_still:
      return "time stood still";
    case Status::time_ran_backwards:
      return "time ran backwards";
    case Status::not_finite:
      return "not finite";
    case Status::wrong_size:
      return "wrong size";
    case Status::jumped:
      return "jumped";
    case Status::not_passive:
      return "not passive";
  }
  return "unknown";
}

Teleoperation::Teleoperation(const RobotModel& robot, BodyPoints points,
                             const ViscosityField& field, const TeleoperationOptions& options)
    : options_(options),
      robot_(robot),
      kinematics_(robot),
      velocity_({.longest_window_s = strict(options) ? plain_difference : options.velocity_window_s,
                 .noise_band = Eigen::VectorXd::Constant(checked_axes(robot), options.noise_band)}),
      handle_velocity_(
          {.longest_window_s = plain_difference, .noise_band = Eigen::VectorXd::Zero(3)}),
      audit_(audited_damping(robot, options)),
      body_(
          std::make_unique<Body>(of_robot(std::move(points), robot), robot.links.size(), options)),
      tree_(std::make_unique<TreeDrag>(robot)),
      q_(AxisVector::Zero(axes_of(robot))),
      qd_(AxisVector::Zero(axes_of(robot))),
      drag_(AxisMatrix::Zero(axes_of(robot), axes_of(robot))),
      view_(std::make_unique<FieldView>(field)) {
  check_fit(robot, options);
  if (options.limiter) limiter_.emplace(limiter_for(robot, options));
  if (options_.tool_link < 0) options_.tool_link = static_cast<int>(robot.links.size()) - 1;
}

Teleoperation::~Teleoperation() = default;

int Teleoperation::joint_count() const noexcept { return static_cast<int>(q_.size()); }

const BodyPoints& Teleoperation::points() const noexcept { return body_->points(); }

PointDrag Teleoperation::point_drag(std::uint32_t point) const noexcept {
  return body_->point_drag(point);
}

void Teleoperation::restart() noexcept {
  velocity_.restart();
  handle_velocity_.restart();
  if (limiter_) limiter_->restart();
  audit_.reset();
  body_->restart();
  counts_ = {};
  last_time_s_ = 0;
  started_ = false;
}

// tick(), one call per stage.
Status Teleoperation::tick(const Input& input, Output& output) noexcept {
  ++counts_.ticks;
  take_new_field();
  const Status heard = hear(input);
  if (heard > Status::deadline_missed) return rest(heard, input, output);
  if (!move(input)) return rest(Status::jumped, input, output);
  body_->feel(*view_);
  carry(output);
  output.status = limit(input, heard, output);
  if (output.status == Status::not_finite) return rest(Status::not_finite, input, output);
  account(input, output);
  return output.status;
}

Status Teleoperation::hear(const Input& input) noexcept {
  const Eigen::Index n = q_.size();
  if (input.joint_count != n || input.q == nullptr) return Status::wrong_size;
  q_ = Eigen::Map<const Eigen::VectorXd>(input.q, n);
  if (!std::isfinite(input.time_s) || !q_.allFinite() || !input.X_WB.matrix().allFinite() ||
      !std::isfinite(input.tau2)) {
    return Status::not_finite;
  }
  const double period_s = input.time_s - last_time_s_;
  if (started_ && period_s == 0) return Status::time_stood_still;
  last_time_s_ = input.time_s;
  velocity_.measure(input.time_s, q_);
  if (started_ && period_s < 0) return Status::time_ran_backwards;
  qd_ = velocity_.velocity();
  if (input.qd != nullptr && !strict(options_)) {
    qd_ = Eigen::Map<const Eigen::VectorXd>(input.qd, n);
  }
  if (!qd_.allFinite()) return Status::not_finite;  // positions apart by more than a number holds
  if (!started_) {
    started_ = true;
    qd_.setZero();
    return Status::started;
  }
  if (period_s > options_.longest_period_s) return Status::deadline_missed;
  for (Eigen::Index c = 0; c < n; ++c) {
    const JointLimits& limits =
        robot_.joints[static_cast<std::size_t>(robot_.coordinates[static_cast<std::size_t>(c)])]
            .limits;
    if (q_[c] < limits.lower - limit_slack || q_[c] > limits.upper + limit_slack) {
      return Status::beyond_joint_limits;
    }
  }
  return Status::ok;
}

bool Teleoperation::move(const Input& input) noexcept {
  kinematics_.update(q_.data(), qd_.data(), input.X_WB);
  if (strict(options_) && cartesian(options_)) {
    const AxisVector tool = kinematics_.p_WL(static_cast<std::size_t>(options_.tool_link));
    handle_velocity_.measure(input.time_s, tool);
  }
  return body_->move(kinematics_, options_.longest_jump_m, view_->field.workspace().voxel_size);
}

void Teleoperation::carry(Output& output) noexcept {
  tree_->carry(kinematics_, body_->link_drag(), drag_);
  output.tool = TreeDrag::total(kinematics_, body_->link_drag(),
                                kinematics_.p_WL(static_cast<std::size_t>(options_.tool_link)));
}

Status Teleoperation::limit(const Input& input, Status heard, Output& output) noexcept {
  const bool missed = heard == Status::deadline_missed;
  double scale = missed ? 0 : 1;
  output.limiter = {};
  output.device_force = AxisVector::Zero(q_.size());
  if (limiter_) {
    const bool by_handle = strict(options_) && cartesian(options_);
    const VelocityEstimator& from = by_handle ? handle_velocity_ : velocity_;
    const LimiterTick tick{.deadline_missed = missed,
                           .held = 1,
                           .spacing_s = from.spacing_s(),
                           .window_s = from.window_s(),
                           .handle_force = output.tool.force.norm()};
    if (options_.limiter->axes == AxisKind::joints) {
      output.limiter = limiter_->limit(drag_, qd_, tick);
    } else {
      // The handle leads the tool: qd = J+ v of it, and its force goes back through the transpose.
      const AxisMatrix map = tool_map();
      const AxisMatrix carried = drag_.lazyProduct(map);
      const AxisMatrix handle_drag = map.transpose().lazyProduct(carried);
      const AxisVector tool_velocity =
          kinematics_.v_WLo(static_cast<std::size_t>(options_.tool_link));
      output.limiter = limiter_->limit(
          handle_drag, by_handle ? handle_velocity_.velocity() : tool_velocity, tick);
    }
    output.device_force = output.limiter.torque;
    scale = output.limiter.scale;
  }
  output.torque = drag_.lazyProduct(qd_);
  if (!output.torque.allFinite() || !output.tool.force.allFinite() ||
      !output.tool.moment.allFinite()) {
    return Status::not_finite;
  }
  output.torque *= -scale;
  if (!limiter_) output.device_force = output.torque;
  output.tool.force *= scale;
  output.tool.moment *= scale;
  output.power = std::max(0.0, -output.torque.dot(qd_));
  // The drag as one point at the tool would feel it: the force that takes the same power there.
  const double speed = kinematics_.v_WLo(static_cast<std::size_t>(options_.tool_link)).norm();
  output.master_force =
      vicinity::master_force(options_.master, speed > 0 ? output.power / speed : 0.0, input.tau2);
  if (missed) {
    ++counts_.missed_deadlines;
    return heard;
  }
  if (limiter_ && output.limiter.status != LimiterStatus::limited) {
    ++counts_.refused;
    return Status::not_passive;
  }
  return heard == Status::ok && !body_->touches(view_->field.workspace()) ? Status::outside_field
                                                                          : heard;
}

void Teleoperation::account(const Input& input, Output& output) noexcept {
  if (cartesian(options_)) {
    const AxisVector tool = kinematics_.p_WL(static_cast<std::size_t>(options_.tool_link));
    audit_.record(input.time_s, tool, output.device_force);
  } else {
    audit_.record(input.time_s, q_, output.device_force);
  }
  output.energy = audit_.balance();
  output.reason = body_->reason(*view_);
  counts_.points_felt = body_->points_felt();
  counts_.points_looked = body_->points_looked();
  output.counts = counts_;
}

// The safe force: none. What follows grows back from it.
Status Teleoperation::rest(Status status, const Input& input, Output& output) noexcept {
  ++counts_.refused;
  if (limiter_) limiter_->drop();
  if (status == Status::jumped) {
    velocity_.restart();
    handle_velocity_.restart();
  }
  const AxisVector none = AxisVector::Zero(cartesian(options_) ? 3 : q_.size());
  // No force acts from now on. What the last one did on the way here cannot be known where the
  // input is not to be trusted; the audit says so.
  const AxisVector nowhere =
      AxisVector::Constant(none.size(), std::numeric_limits<double>::quiet_NaN());
  audit_.record(input.time_s, nowhere, none);
  output = {};
  output.status = status;
  output.torque = AxisVector::Zero(q_.size());
  output.device_force = none;
  output.master_force =
      std::isfinite(input.tau2) ? vicinity::master_force(options_.master, 0, input.tau2) : 0;
  output.energy = audit_.balance();
  counts_.points_felt = counts_.points_looked = 0;
  output.counts = counts_;
  return status;
}

AxisMatrix Teleoperation::tool_map() const noexcept {
  const auto tool = static_cast<std::size_t>(options_.tool_link);
  const Vec3& p_WT = kinematics_.p_WL(tool);
  AxisMatrix J = AxisMatrix::Zero(3, q_.size());
  for (auto link = tool; link > 0;) {
    const Joint& joint = robot_.joints[link - 1];
    if (joint.coordinate >= 0) {
      const Vec3 axis_W = kinematics_.R_WL(link) * joint.axis_J;
      const Vec3 velocity = joint.type == JointType::prismatic
                                ? axis_W
                                : Vec3(axis_W.cross(p_WT - kinematics_.p_WL(link)));
      J.col(joint.coordinate) += joint.multiplier * velocity;
    }
    link = static_cast<std::size_t>(joint.parent);
  }
  // J' (J J' + e 1)^-1: near a singularity the handle moves the joints less, not infinitely.
  Eigen::Matrix3d square = J.lazyProduct(J.transpose());
  square.diagonal().array() += singular_slack;
  const Eigen::Matrix3d inverse = square.inverse();
  return J.transpose().lazyProduct(inverse);
}

void Teleoperation::take_new_field() noexcept {
  if (!views_.waits()) return;
  const Workspace from = view_->field.workspace();
  views_.take(view_);
  const Workspace& to = view_->field.workspace();
  if (from.origin == to.origin && from.voxel_size == to.voxel_size) {
    body_->look_again();
  } else {
    body_->restart();
  }
  ++counts_.fields_taken;
}

void Teleoperation::swap_field(const ViscosityField& field) {
  views_.offer(std::make_unique<FieldView>(field));
}

}  // namespace vicinity
