// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/vicinity.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/teleop/device.h"
#include "vicinity/teleop/tick.h"
#include "vicinity/viscosity/field_file.h"

struct vicinity_arm {
  vicinity::RobotModel robot;
  std::vector<std::string> objects;  // of the field that was given last
  std::unique_ptr<vicinity::Teleoperation> teleoperation;
  vicinity::Output output;
};

namespace {

using vicinity::Error;
using vicinity::Status;

// The C enumerations are those of the core, number by number.
constexpr bool same(vicinity_status c, Status core) {
  return static_cast<int>(c) == static_cast<int>(core);
}
static_assert(same(VICINITY_OK, Status::ok) && same(VICINITY_STARTED, Status::started) &&
              same(VICINITY_BEYOND_JOINT_LIMITS, Status::beyond_joint_limits) &&
              same(VICINITY_OUTSIDE_FIELD, Status::outside_field) &&
              same(VICINITY_DEADLINE_MISSED, Status::deadline_missed) &&
              same(VICINITY_TIME_STOOD_STILL, Status::time_stood_still) &&
              same(VICINITY_TIME_RAN_BACKWARDS, Status::time_ran_backwards) &&
              same(VICINITY_NOT_FINITE, Status::not_finite) &&
              same(VICINITY_WRONG_SIZE, Status::wrong_size) &&
              same(VICINITY_JUMPED, Status::jumped) &&
              same(VICINITY_NOT_PASSIVE, Status::not_passive));
static_assert(VICINITY_MAX_JOINTS == vicinity::axis_capacity);

thread_local std::string last_error;

// Runs what may throw; no exception may reach C.
template <class Step>
bool succeeds(Step&& step) noexcept {
  try {
    last_error.clear();
    step();
    return true;
  } catch (const std::exception& error) {
    try {
      last_error = error.what();
    } catch (...) {
      last_error.clear();
    }
  } catch (...) {
    last_error.clear();
  }
  return false;
}

const char* needed(const char* text, const char* what) {
  if (text == nullptr) throw Error({.what = std::string(what) + " is a null pointer"});
  return text;
}

int tool_link(const vicinity::RobotModel& robot, const char* name) {
  if (name == nullptr) return -1;
  if (const auto link = robot.find_link(name)) return *link;
  std::vector<std::string> links;
  for (const vicinity::Link& link : robot.links) links.push_back(link.name);
  throw Error({.where = "tool",
               .what = "the robot has no such link",
               .found = std::string("'") + name + "'",
               .hint = vicinity::nearest_word(name, links)});
}

// An enumerator of vicinity.h, 0 or 1; C can set it to any number.
template <class Value>
Value one_of_two(int choice, Value first, Value second, const char* what) {
  if (choice == 0) return first;
  if (choice == 1) return second;
  throw Error({.where = what, .what = "is none of its values", .found = std::to_string(choice)});
}

vicinity::BodyPointOptions body_point_options(const vicinity_options& options) {
  vicinity::BodyPointOptions points;
  points.points_per_m2 = options.points_per_m2;
  if (options.points > 0) points.total = options.points;
  if (options.exclude_count > 0 && options.exclude == nullptr) needed(nullptr, "exclude");
  for (std::size_t n = 0; n < options.exclude_count; ++n) {
    points.exclude.emplace_back(needed(options.exclude[n], "a link to exclude"));
  }
  return points;
}

vicinity::TeleoperationOptions teleoperation_options(const vicinity_options& options,
                                                     const vicinity::RobotModel& robot) {
  vicinity::TeleoperationOptions result;
  if (options.memory != nullptr) result.memory = vicinity::named_memory(options.memory);
  result.direction = one_of_two(options.direction, vicinity::DragDirection::all,
                                vicinity::DragDirection::closing, "direction");
  result.traversal = one_of_two(options.traversal, vicinity::Traversal::swept,
                                vicinity::Traversal::sampled, "traversal");
  result.tool_link = tool_link(robot, options.tool);
  result.longest_period_s = options.longest_period_s;
  result.master.gain = options.gain;
  result.master.attenuation = options.attenuation;
  result.master.lever = options.lever;
  result.master.torque_constant = options.torque_constant;
  if (options.device != nullptr) {
    const auto mode = one_of_two(options.mode, vicinity::LimiterMode::strict,
                                 vicinity::LimiterMode::device, "mode");
    result.limiter = vicinity::limiter_options(vicinity::find_device(options.device), mode);
  }
  return result;
}

std::vector<std::string> object_names(const vicinity::ViscosityField& field) {
  std::vector<std::string> names;
  for (const vicinity::FieldObject& object : field.objects()) names.push_back(object.name);
  return names;
}

std::unique_ptr<vicinity_arm> create(const char* field_file, const char* urdf_file,
                                     const vicinity_options& options) {
  // Before anything else of it is read: another version's may be shorter.
  if (options.struct_size != sizeof(vicinity_options)) {
    throw Error({.where = "options",
                 .what = "their struct_size is not this version's",
                 .found = std::to_string(options.struct_size),
                 .expected = std::to_string(sizeof(vicinity_options)),
                 .hint = "vicinity_default_options()"});
  }
  auto arm = std::make_unique<vicinity_arm>();
  const vicinity::ViscosityField field = vicinity::open_field(needed(field_file, "field_file"));
  arm->robot = vicinity::read_urdf(needed(urdf_file, "urdf_file")).robot;
  arm->objects = object_names(field);
  arm->teleoperation = std::make_unique<vicinity::Teleoperation>(
      arm->robot, vicinity::sample_body_points(arm->robot, body_point_options(options)), field,
      teleoperation_options(options, arm->robot));
  return arm;
}

void copy(const vicinity::Vec3& from, double (&to)[3]) noexcept { std::copy_n(from.data(), 3, to); }

void write(const vicinity::Output& from, vicinity_output& to) noexcept {
  to = vicinity_empty_output();
  to.status = static_cast<vicinity_status>(from.status);
  to.joint_count = static_cast<int>(from.torque.size());
  std::copy_n(from.torque.data(), from.torque.size(), to.torque);
  copy(from.tool.force, to.force);
  copy(from.tool.moment, to.moment);
  to.master_force = from.master_force;
  to.power = from.power;
  const bool limited = from.limiter.torque.size() > 0;  // there is a limiter, and it was asked
  to.scale = limited ? from.limiter.scale : from.status < Status::deadline_missed ? 1 : 0;
  to.reason_link = from.reason.link;
  to.reason_object = from.reason.object;
  to.reason_rank = from.reason.object < 0 ? -1 : from.reason.rank;
  to.reason_share = from.reason.share;
  to.reason_distance_m = from.reason.distance_m;
  to.reason_time_to_contact_s = from.reason.time_to_contact_s;
  to.points_felt = from.counts.points_felt;
  to.energy_drag = from.energy.drag;
  to.passive = from.energy.passive ? 1 : 0;
  to.ticks = from.counts.ticks;
  to.refused = from.counts.refused;
  to.missed_deadlines = from.counts.missed_deadlines;
}

template <class Names>
bool has(const Names& names, int n) noexcept {
  return n >= 0 && static_cast<std::size_t>(n) < names.size();
}

}  // namespace

extern "C" {

const char* vicinity_status_name(int status) {
  if (status == VICINITY_BAD_CALL) return "bad call";
  if (status < 0 || status > VICINITY_BAD_CALL) return "unknown";
  return vicinity::to_string(static_cast<Status>(status));
}

vicinity_options vicinity_default_options(void) {
  const vicinity::TeleoperationOptions usual;
  vicinity_options options{};
  options.struct_size = sizeof options;
  options.points_per_m2 = vicinity::BodyPointOptions().points_per_m2;
  options.longest_period_s = usual.longest_period_s;
  options.gain = usual.master.gain;
  options.attenuation = usual.master.attenuation;
  options.lever = usual.master.lever;
  options.torque_constant = usual.master.torque_constant;
  return options;
}

vicinity_input vicinity_empty_input(void) {
  vicinity_input input{};
  input.struct_size = sizeof input;
  return input;
}

vicinity_output vicinity_empty_output(void) {
  vicinity_output output{};
  output.struct_size = sizeof output;
  output.reason_link = output.reason_object = output.reason_rank = -1;
  return output;
}

vicinity_arm* vicinity_create(const char* field_file, const char* urdf_file,
                              const vicinity_options* options) {
  const vicinity_options usual = vicinity_default_options();
  std::unique_ptr<vicinity_arm> arm;
  succeeds([&] { arm = create(field_file, urdf_file, options != nullptr ? *options : usual); });
  return arm.release();
}

void vicinity_destroy(vicinity_arm* arm) { delete arm; }

int vicinity_joint_count(const vicinity_arm* arm) {
  return arm == nullptr ? 0 : arm->teleoperation->joint_count();
}

const char* vicinity_joint_name(const vicinity_arm* arm, int joint) {
  if (arm == nullptr || !has(arm->robot.coordinates, joint)) return nullptr;
  const int index = arm->robot.coordinates[static_cast<std::size_t>(joint)];
  return arm->robot.joints[static_cast<std::size_t>(index)].name.c_str();
}

const char* vicinity_link_name(const vicinity_arm* arm, int link) {
  if (arm == nullptr || !has(arm->robot.links, link)) return nullptr;
  return arm->robot.links[static_cast<std::size_t>(link)].name.c_str();
}

const char* vicinity_object_name(const vicinity_arm* arm, int object) {
  if (arm == nullptr || !has(arm->objects, object)) return nullptr;
  return arm->objects[static_cast<std::size_t>(object)].c_str();
}

vicinity_status vicinity_tick(vicinity_arm* arm, const vicinity_input* input,
                              vicinity_output* output) {
  if (output == nullptr || output->struct_size != sizeof *output) return VICINITY_BAD_CALL;
  if (arm == nullptr || input == nullptr || input->struct_size != sizeof *input) {
    *output = vicinity_empty_output();
    return output->status = VICINITY_BAD_CALL;
  }
  vicinity::Input in{.time_s = input->time_s,
                     .q = input->q,
                     .qd = input->qd,
                     .joint_count = input->joint_count,
                     .tau2 = input->tau2};
  if (const double* base = input->base) {
    in.X_WB = vicinity::pose_from_rpy({base[0], base[1], base[2]}, {base[3], base[4], base[5]});
  }
  (void)arm->teleoperation->tick(in, arm->output);  // the output holds its status
  write(arm->output, *output);
  return output->status;
}

int vicinity_swap_field(vicinity_arm* arm, const char* field_file) {
  const bool swapped = succeeds([&] {
    if (arm == nullptr) throw Error({.what = "arm is a null pointer"});
    const vicinity::ViscosityField field = vicinity::open_field(needed(field_file, "field_file"));
    std::vector<std::string> names = object_names(field);
    arm->teleoperation->swap_field(field);
    arm->objects = std::move(names);
  });
  return swapped ? 0 : -1;
}

const char* vicinity_last_error(void) { return last_error.c_str(); }

}  // extern "C"
