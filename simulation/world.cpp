// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/world.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

constexpr double longest_step_s = 0.005;
constexpr double box_reach = 0.03;      // boxes that near are in the model [m]
constexpr std::uint64_t box_steps = 4;  // and chosen anew so often: at 1 m/s, 8 mm later

struct FreeModel {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
};
struct FreeData {
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
};
using ModelPointer = std::unique_ptr<mjModel, FreeModel>;
using DataPointer = std::unique_ptr<mjData, FreeData>;

ModelPointer compiled(const std::string& mjcf, const std::string& robot) {
  auto files = std::make_unique<mjVFS>();  // two megabytes
  mj_defaultVFS(files.get());
  const int size = static_cast<int>(mjcf.size());
  mj_makeEmptyFileVFS(files.get(), "arm.xml", size + 1);
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());
  static_cast<char*>(files->filedata[0])[mjcf.size()] = '\0';
  std::string why(500, '\0');
  ModelPointer model(mj_loadXML("arm.xml", files.get(), why.data(), static_cast<int>(why.size())));
  mj_deleteVFS(files.get());
  why.resize(std::strlen(why.c_str()));
  std::replace(why.begin(), why.end(), '\n', ' ');
  if (model) return model;
  throw Error({.where = "robot '" + robot + "'",
               .what = "its masses and joints cannot be simulated",
               .found = why});
}

const WorldOptions& checked(const WorldOptions& options) {
  const auto refuse = [](const char* what, double found, std::string expected) {
    throw Error({.where = "simulated world",
                 .what = what,
                 .found = std::to_string(found),
                 .expected = std::move(expected)});
  };
  if (!(options.step_s > 0 && options.step_s <= longest_step_s)) {
    refuse("the time step of the physics cannot be used", options.step_s,
           "more than 0 and at most 0.005 s: beyond, contacts gain energy");
  }
  if (!(options.servo_frequency_hz > 0) || !(options.servo_frequency_hz * options.step_s < 0.1) ||
      !(options.servo_damping > 0)) {
    refuse("the slave's servo cannot be held stable", options.servo_frequency_hz,
           "a frequency below a tenth of the steps, and damping above zero");
  }
  return options;
}

}  // namespace

struct World::Physics {
  ModelPointer model;
  DataPointer data;
  std::vector<int> joint_address;               // by robot joint; -1: fixed
  std::vector<int> joint_coordinate;            // by robot joint
  std::vector<double> multiplier, offset;       // by robot joint
  std::vector<int> coordinate_joint;            // by coordinate: robot joint
  std::vector<int> body;                        // by robot link
  std::vector<std::pair<int, Capsule>> shapes;  // geom, in its own frame
  std::vector<double> wanted, torque;           // by degree of freedom
  std::vector<Capsule> capsules_W;
  std::vector<std::uint32_t> near;
  std::vector<double> effort;  // limit by degree of freedom
  int boxes = 0;
};

World::World(const RobotModel& robot, std::shared_ptr<const VoxelBoxes> boxes,
             const WorldOptions& options)
    : physics_(std::make_unique<Physics>()), boxes_(std::move(boxes)) {
  checked(options);
  const double w = 2 * std::numbers::pi * options.servo_frequency_hz;
  stiffness_ = w * w;
  damping_ = 2 * options.servo_damping * w;
  Physics& p = *physics_;
  const ArmModelOptions arm{.X_WB = options.X_WB, .step_s = options.step_s};
  p.boxes = arm.contact_boxes;
  p.model = compiled(arm_as_mjcf(robot, arm), robot.name);
  p.model->opt.gravity[0] = p.model->opt.gravity[1] = 0;
  p.model->opt.gravity[2] = -options.gravity;
  p.data.reset(mj_makeData(p.model.get()));
  if (!p.data)
    throw Error({.where = "robot '" + robot.name + "'", .what = "no memory to simulate it"});
  const auto dofs = static_cast<std::size_t>(p.model->nv);
  p.wanted.resize(dofs);
  p.torque.resize(dofs);
  p.effort.assign(dofs, HUGE_VAL);
  for (const Link& link : robot.links) {
    p.body.push_back(mj_name2id(p.model.get(), mjOBJ_BODY, link.name.c_str()));
  }
  for (const Joint& joint : robot.joints) {
    const bool fixed = joint.type == JointType::fixed;
    const int id = fixed ? -1 : mj_name2id(p.model.get(), mjOBJ_JOINT, joint.name.c_str());
    p.joint_address.push_back(id < 0 ? -1 : p.model->jnt_dofadr[id]);
    p.joint_coordinate.push_back(joint.coordinate);
    p.multiplier.push_back(joint.multiplier);
    p.offset.push_back(joint.offset);
    if (id >= 0) p.effort[static_cast<std::size_t>(p.joint_address.back())] = joint.limits.effort;
  }
  p.coordinate_joint.assign(robot.coordinates.begin(), robot.coordinates.end());
  // Boxes are put where they are needed: none sits in its body's frame, as the compiler found it.
  std::fill_n(p.model->geom_sameframe, p.boxes, mjtByte{0});
  for (int geom = p.boxes; geom < p.model->ngeom; ++geom) {
    const mjtNum* size = p.model->geom_size + 3 * geom;
    const double half = p.model->geom_type[geom] == mjGEOM_CAPSULE ? size[1] : 0;
    p.shapes.push_back({geom, {Vec3(0, 0, -half), Vec3(0, 0, half), size[0]}});
  }
  p.capsules_W.resize(p.shapes.size());
  start(AxisVector::Zero(static_cast<Eigen::Index>(robot.coordinates.size())));
}

World::~World() = default;

double World::step_s() const noexcept { return physics_->model->opt.timestep; }

void World::start(const AxisVector& q) {
  Physics& p = *physics_;
  mj_resetData(p.model.get(), p.data.get());
  for (std::size_t j = 0; j < p.joint_address.size(); ++j) {
    if (p.joint_address[j] < 0) continue;
    const double at = p.joint_coordinate[j] < 0 ? 0 : q[p.joint_coordinate[j]];
    p.data->qpos[p.joint_address[j]] = p.multiplier[j] * at + p.offset[j];
  }
  steps_ = 0;
  servo_on_ = true;
  tau2_ = AxisVector::Zero(q.size());
  q_ = q;
  contacts_ = {};
  mj_kinematics(p.model.get(), p.data.get());
  bring_boxes();
  mj_forward(p.model.get(), p.data.get());
  read_joints();
}

// Only what is near: contacts cost nothing in free space.
void World::bring_boxes() {
  Physics& p = *physics_;
  mjModel& model = *p.model;
  for (std::size_t n = 0; n < p.shapes.size(); ++n) {
    const auto& [geom, shape] = p.shapes[n];
    const Vec3 at = Eigen::Map<const Vec3>(p.data->geom_xpos + 3 * geom);
    const mjtNum* const turn = p.data->geom_xmat + 9 * geom;
    const Vec3 axis_W(turn[2], turn[5], turn[8]);
    p.capsules_W[n] = {at + shape.from.z() * axis_W, at + shape.to.z() * axis_W, shape.radius};
  }
  boxes_->near(p.capsules_W, box_reach, static_cast<std::size_t>(p.boxes), p.near);
  for (int n = 0; n < p.boxes; ++n) {
    const bool used = static_cast<std::size_t>(n) < p.near.size();
    model.geom_contype[n] = used ? 1 : 0;
    model.geom_conaffinity[n] = used ? 2 : 0;
    if (!used) continue;
    const Box& box = boxes_->boxes()[p.near[static_cast<std::size_t>(n)]];
    const Vec3 half = 0.5 * box.sizes();
    Eigen::Map<Vec3>(model.geom_pos + 3 * n) = box.center();
    Eigen::Map<Vec3>(model.geom_size + 3 * n) = half;
    model.geom_rbound[n] = half.norm();
  }
  if (p.near.empty()) {
    model.opt.disableflags |= mjDSBL_CONTACT;
  } else {
    model.opt.disableflags &= ~mjDSBL_CONTACT;
  }
}

bool World::step(const AxisVector& q_led, const AxisVector& qd_led) {
  Physics& p = *physics_;
  mjModel* const model = p.model.get();
  mjData* const data = p.data.get();
  if (steps_++ % box_steps == 0) bring_boxes();
  mj_step1(model, data);
  look_at_contacts();
  std::fill(p.wanted.begin(), p.wanted.end(), 0.0);
  for (std::size_t j = 0; j < p.joint_address.size(); ++j) {
    const int dof = p.joint_address[j], c = p.joint_coordinate[j];
    if (dof < 0) continue;
    const double led = c < 0 ? p.offset[j] : p.multiplier[j] * q_led[c] + p.offset[j];
    const double led_rate = c < 0 ? 0 : p.multiplier[j] * qd_led[c];
    p.wanted[static_cast<std::size_t>(dof)] =
        stiffness_ * (led - data->qpos[dof]) + damping_ * (led_rate - data->qvel[dof]);
  }
  mj_mulM(model, data, p.torque.data(), p.wanted.data());
  for (std::size_t dof = 0; dof < p.torque.size(); ++dof) {
    if (!servo_on_) p.torque[dof] = -data->qfrc_bias[dof];
    const double all = p.torque[dof] + data->qfrc_bias[dof];
    const double given = std::clamp(all, -p.effort[dof], p.effort[dof]);
    data->qfrc_applied[dof] = given;
    p.torque[dof] = given - data->qfrc_bias[dof];
  }
  mj_step2(model, data);
  const bool sound =
      std::all_of(data->qpos, data->qpos + model->nq, [](double q) { return std::abs(q) < 1e6; }) &&
      std::all_of(data->qvel, data->qvel + model->nv, [](double v) { return std::abs(v) < 1e6; });
  if (!sound || data->warning[mjWARN_BADQACC].number > 0) {
    start(q_);
    return false;
  }
  if (contacts_.count > 0) {
    contacts_.force = 0;
    contacts_.force_W.setZero();
    for (int n = 0; n < data->ncon; ++n) {
      mjtNum wrench[6];
      mj_contactForce(model, data, n, wrench);
      // Rows of the frame: the normal, from the first geom to the second, and two tangents.
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> frame(
          data->contact[n].frame);
      const double sign = data->contact[n].geom2 >= p.boxes ? 1 : -1;
      contacts_.force += wrench[0];
      contacts_.force_W += sign * (frame.transpose() * Eigen::Map<const Vec3>(wrench));
    }
  }
  read_joints();
  return true;
}

// Before the contact pushes: positions and velocities are those of the step's beginning.
void World::look_at_contacts() {
  Physics& p = *physics_;
  contacts_ = {};
  contacts_.count = p.data->ncon;
  for (int n = 0; n < p.data->ncon; ++n) {
    const mjContact& contact = p.data->contact[n];
    const int geom = contact.geom2 >= p.boxes ? contact.geom2 : contact.geom1;
    mjtNum twist[6];
    mj_objectVelocity(p.model.get(), p.data.get(), mjOBJ_GEOM, geom, twist, 0);
    const Vec3 turn(twist[0], twist[1], twist[2]), v(twist[3], twist[4], twist[5]);
    const Vec3 lever =
        Eigen::Map<const Vec3>(contact.pos) - Eigen::Map<const Vec3>(p.data->geom_xpos + 3 * geom);
    const Vec3 v_contact = v + turn.cross(lever);
    const double along = v_contact.dot(Eigen::Map<const Vec3>(contact.frame));
    contacts_.closing_speed =
        std::max(contacts_.closing_speed, contact.geom2 == geom ? -along : along);
  }
}

void World::read_joints() {
  Physics& p = *physics_;
  for (std::size_t c = 0; c < p.coordinate_joint.size(); ++c) {
    const auto j = static_cast<std::size_t>(p.coordinate_joint[c]);
    const auto at = static_cast<Eigen::Index>(c);
    q_[at] = (p.data->qpos[p.joint_address[j]] - p.offset[j]) / p.multiplier[j];
    tau2_[at] = steps_ > 0 ? p.torque[static_cast<std::size_t>(p.joint_address[j])] : 0;
  }
}

Pose World::X_WL(std::size_t link) const {
  const auto body = static_cast<std::size_t>(physics_->body[link]);
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Map<const Vec3>(physics_->data->xpos + 3 * body);
  pose.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
      physics_->data->xmat + 9 * body);
  return pose;
}

}  // namespace vicinity
