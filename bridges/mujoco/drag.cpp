// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mujoco/drag.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "bodies.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

static_assert(std::is_same_v<mjtNum, double>, "MuJoCo in single precision");

constexpr int rigid_axes = 6;

// A body alone: the base is where the body is, and three slides and three hinges at zero say how it
// moves, in its own axes.
RobotModel rigid_body(const std::string& name) {
  RobotModel robot{.name = name, .links = {{.name = "frame"}}, .joints = {}, .coordinates = {}};
  for (int axis = 0; axis < rigid_axes; ++axis) {
    robot.joints.push_back({.name = axis < 3 ? "slide" : "hinge",
                            .type = axis < 3 ? JointType::prismatic : JointType::continuous,
                            .parent = axis,
                            .axis_J = Vec3::Unit(axis % 3),
                            .coordinate = axis,
                            .limits = {}});
    robot.links.push_back({.name = name});
    robot.coordinates.push_back(axis);
  }
  return robot;
}

// The points of one link, as those of a rigid body.
BodyPoints points_of(const BodyPoints& all, const BodyPoints::LinkRange& range) {
  BodyPoints own;
  const auto copy = [&](const BodyPoints::Lane& from, BodyPoints::Lane& to) {
    const std::size_t lanes = (range.end - range.begin + BodyPoints::lane - 1) / BodyPoints::lane;
    const auto first = from.begin() + range.begin;
    to.assign(first, first + static_cast<std::ptrdiff_t>(lanes * BodyPoints::lane));
  };
  copy(all.x, own.x);
  copy(all.y, own.y);
  copy(all.z, own.z);
  copy(all.area, own.area);
  for (std::uint32_t c = range.first_cluster; c < range.last_cluster; ++c) {
    BodyPoints::Cluster cluster = all.clusters[c];
    cluster.begin -= range.begin;
    cluster.end -= range.begin;
    own.clusters.push_back(cluster);
  }
  BodyPoints::LinkRange link = range;
  link.link = rigid_axes;
  link.begin = 0;
  link.end = range.end - range.begin;
  link.first_cluster = 0;
  link.last_cluster = static_cast<std::uint32_t>(own.clusters.size());
  own.links.push_back(link);
  return own;
}

TeleoperationOptions tick_options(const MuJoCoDragOptions& options) {
  TeleoperationOptions tick;
  tick.memory = options.memory;
  tick.direction = options.direction;
  tick.traversal = options.traversal;
  tick.longest_period_s = 1e15;  // a simulation has no deadlines
  return tick;
}

const mjModel& checked(const mjModel* model, const MuJoCoDragOptions& options) {
  const auto refuse = [](const char* what) {
    throw Error({.where = "drag in MuJoCo", .what = what});
  };
  if (model == nullptr) refuse("there is no model");
  if (!options.X_WM.matrix().allFinite()) refuse("the pose of the model's world is not finite");
  return *model;
}

}  // namespace

struct MuJoCoDrag::Bodies {
  struct Body {
    int body = 0;
    std::uint32_t first_point = 0;
    std::unique_ptr<Teleoperation> teleoperation;
  };

  Pose X_WM;
  int body_count, dof_count;
  BodyPoints points;
  std::vector<Body> bodies;
  std::vector<mjtNum> force, answer;  // by degree of freedom
  double clock_s = 0;                 // of the ticks: it only has to go on
  MuJoCoDragOutput output;

  Status tick(Body& body, Input input, Output& felt) noexcept;
  void feel(Body& body, const mjModel& model, mjData& data) noexcept;
};

MuJoCoDrag::MuJoCoDrag(const mjModel* model, const ViscosityField& field,
                       const MuJoCoDragOptions& options) {
  const RobotModel surfaces = surfaces_of(checked(model, options), options.bodies);
  const auto dofs = static_cast<std::size_t>(model->nv);
  bodies_.reset(new Bodies{.X_WM = options.X_WM,
                           .body_count = model->nbody,
                           .dof_count = model->nv,
                           .points = sample_body_points(surfaces, options.points),
                           .bodies = {},
                           .force = std::vector<mjtNum>(dofs),
                           .answer = std::vector<mjtNum>(dofs),
                           .output = {}});
  for (const BodyPoints::LinkRange& range : bodies_->points.links) {
    if (model->body_weldid[range.link] == 0) continue;  // a named point on what stands still
    bodies_->bodies.push_back(
        {range.link, range.begin,
         std::make_unique<Teleoperation>(
             rigid_body(surfaces.links[static_cast<std::size_t>(range.link)].name),
             points_of(bodies_->points, range), field, tick_options(options))});
  }
  if (!bodies_->bodies.empty()) return;
  throw Error({.where = "drag in MuJoCo",
               .what = "no body of '" + surfaces.name + "' that moves, and counts, has a surface",
               .hint = "a joint and a geom for it"});
}

MuJoCoDrag::~MuJoCoDrag() = default;

const MuJoCoDragOutput& MuJoCoDrag::output() const noexcept { return bodies_->output; }

const BodyPoints& MuJoCoDrag::points() const noexcept { return bodies_->points; }

// The first tick of all, and the one after a jump, only take the place in.
Status MuJoCoDrag::Bodies::tick(Body& body, Input input, Output& felt) noexcept {
  Status status = Status::started;
  for (int tries = 0; tries < 3; ++tries) {
    if (status != Status::started && status != Status::jumped) break;
    input.time_s = clock_s += 1;
    status = body.teleoperation->tick(input, felt);
  }
  return status;
}

void MuJoCoDrag::Bodies::feel(Body& body, const mjModel& model, mjData& data) noexcept {
  using Rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const mjtNum* const xpos = data.xpos + 3 * body.body;
  const Eigen::Map<const Rotation> R_MB(data.xmat + 9 * body.body);
  Pose X_MB = Pose::Identity();
  X_MB.linear() = R_MB;
  X_MB.translation() = Eigen::Map<const Vec3>(xpos);

  std::array<mjtNum, rigid_axes> twist{};  // angular, linear
  mj_objectVelocity(&model, &data, mjOBJ_XBODY, body.body, twist.data(), 1);
  const std::array<double, rigid_axes> q{};
  const std::array<double, rigid_axes> qd{twist[3], twist[4], twist[5],
                                          twist[0], twist[1], twist[2]};
  const Input input{.q = q.data(), .qd = qd.data(), .joint_count = rigid_axes, .X_WB = X_WM * X_MB};
  Output felt;
  tick(body, input, felt);
  if (felt.torque.isZero(0)) return;
  const Vec3 force_M = R_MB * felt.torque.head<3>();
  const Vec3 moment_M = R_MB * felt.torque.segment<3>(3);
  mj_applyFT(&model, &data, force_M.data(), moment_M.data(), xpos, body.body, force.data());
  // The reason of all is that of the point which takes most.
  output.power += felt.power;
  const double most = output.reason.share;  // in watts until all have been asked
  if (felt.reason.point >= 0 && felt.reason.share * felt.power > most) {
    output.reason = felt.reason;
    output.reason.share *= felt.power;
    output.reason.link = body.body;
    output.reason.point += static_cast<int>(body.first_point);
  }
}

bool MuJoCoDrag::apply(const mjModel* model, mjData* data) noexcept {
  Bodies& all = *bodies_;
  all.output = {};
  if (model == nullptr || data == nullptr || model->nbody != all.body_count ||
      model->nv != all.dof_count) {
    return false;
  }
  std::fill(all.force.begin(), all.force.end(), 0.0);
  for (Bodies::Body& body : all.bodies) all.feel(body, *model, *data);
  MuJoCoDragOutput& output = all.output;
  if (output.power > 0) output.reason.share /= output.power;

  // A step of h changes the motion by h M^-1 force. As far as the power it takes, s P h, exceeds
  // what that change brings in, (s h)² force' M^-1 force / 2, the motion loses energy; most at
  // s = P / (h force' M^-1 force), where the drag brings it to a stop.
  const Eigen::Map<const Eigen::VectorXd> force(all.force.data(), model->nv);
  const Eigen::Map<const Eigen::VectorXd> velocity(data->qvel, model->nv);
  if (force.isZero(0)) return true;
  mj_solveM(model, data, all.answer.data(), all.force.data(), 1);
  const Eigen::Map<const Eigen::VectorXd> answer(all.answer.data(), model->nv);
  const double taken = std::max(0.0, -force.dot(velocity));
  const double stops = model->opt.timestep * force.dot(answer);
  if (!(stops <= taken)) output.scale = std::isfinite(stops) ? taken / stops : 0;
  output.power = output.scale * taken;
  Eigen::Map<Eigen::VectorXd>(data->qfrc_passive, model->nv) += output.scale * force;
  return true;
}

}  // namespace vicinity
