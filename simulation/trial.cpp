// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/trial.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vicinity {
namespace {

constexpr double period_s = 0.001;  // of the master
constexpr double attenuation = 20;  // A: a contact of 100 N is felt as 5 N
constexpr double settle_s = 0.3;    // watched for so long after the operator believes to be there
constexpr int clearance_steps = 4;  // of the slave between two looks at its clearance
constexpr double training_speed = 0.06;  // [m/s]
constexpr double training_reach = 0.01;  // this near to the goal counts as there [m]

int slave_periods_of(const Workplace& place) {
  return std::max(1, static_cast<int>(std::lround(place.step_s / period_s)));
}

double asked_every(const Workplace& place, const Condition& condition) {
  return condition.placement == Placement::remote ? place.step_s : period_s;
}

LoopOptions loop_options(const Workplace& place, const Condition& condition) {
  LoopOptions options;
  options.period_s = period_s;
  options.slave_periods = slave_periods_of(place);
  options.there = {condition.delay_s / 2, condition.jitter_s, condition.loss, 0};
  options.back = options.there;
  options.placement = condition.placement;
  options.master.attenuation = attenuation;
  options.reflected_limit = condition.device.force_limit.value_or(0);
  const auto value = [](const std::vector<double>& list) { return list.empty() ? 0 : list[0]; };
  options.encoder_step = Eigen::VectorXd::Constant(3, value(condition.device.encoder_step));
  options.damping = Eigen::Matrix3d::Identity() * value(condition.device.physical_damping);
  return options;
}

// How far off a surface is still known: what is farther away has no distance [m].
double reach_of(const ViscosityField& field) {
  double reach = 0;
  for (const FieldObject& object : field.objects()) {
    reach = std::max(reach, object.m * object.q * field.workspace().voxel_size);
  }
  return reach;
}

// What comes late: the picture of the tool, and the bump of a contact.
class Late {
 public:
  explicit Late(double delay_s)
      : kept_(static_cast<std::size_t>(std::lround(delay_s / period_s)) + 1) {}
  void fill(const Vec3& tool) { std::fill(kept_.begin(), kept_.end(), Seen{tool, 0}); }
  void show(const Vec3& tool, double bump) {
    at_ = (at_ + 1) % kept_.size();
    kept_[at_] = {tool, bump};
  }
  const Vec3& tool() const { return kept_[(at_ + 1) % kept_.size()].tool; }
  double bump() const { return kept_[(at_ + 1) % kept_.size()].bump; }

 private:
  struct Seen {
    Vec3 tool = Vec3::Zero();
    double bump = 0;
  };
  std::vector<Seen> kept_;
  std::size_t at_ = 0;
};

// Hand and handle as one mass under forces that are held for a period.
class Handle {
 public:
  Handle(const Device& device, double hand_mass, const Vec3& at) : x(at) {
    const auto value = [](const std::vector<double>& list) { return list.empty() ? 0 : list[0]; };
    mass_ = hand_mass + value(device.mass);
    damping_ = value(device.physical_damping);
    friction_ = value(device.dry_friction);
  }
  void move(const Vec3& force) {
    v += period_s / mass_ * (force - damping_ * v);
    // Dry friction takes what speed there is, and no more.
    const double speed = v.norm(), lost = friction_ * period_s / mass_;
    v *= speed > lost ? 1 - lost / speed : 0;
    x += period_s * v;
  }
  Vec3 x, v = Vec3::Zero();

 private:
  double mass_, damping_, friction_;
};

}  // namespace

Trial::Trial(const Workplace& place, const Task& task, const Method& method,
             const Condition& condition)
    : place_(place),
      task_(task),
      method_(method),
      condition_(condition),
      aid_(fit_aid(place, method, condition.device, asked_every(place, condition))),
      loop_(Lead(place.robot, AxisKind::cartesian, place.tool_link, place.X_WB), *aid_.aid,
            loop_options(place, condition)),
      world_(place.robot, place.boxes,
             {.X_WB = place.X_WB, .step_s = period_s * slave_periods_of(place)}),
      distance_(place.robot, place.points, place.distance, place.distance_clearance) {}

const Output* Trial::last_tick() const noexcept {
  return method_.kind == MethodKind::drag ? &static_cast<const DragAid*>(aid_.aid.get())->output()
                                          : nullptr;
}

Training Trial::train() {
  Training trained{method_.cue, 0};
  if (method_.cue == Cue::none || !task_.intent.stops_by_feel) return trained;
  OperatorParameters person = person_;
  person.noise = person.depth_error_m = person.across_error_m = 0;
  Intent intent = task_.intent;
  intent.speed = training_speed;
  intent.careful = intent.stops_by_feel = false;
  double level = 0;
  go(person, intent, trained, 0, 2 * task_.limit_s, &level, nullptr);
  trained.level = level;
  return trained;
}

TrialResult Trial::run(std::uint64_t seed, const Training& trained, const TrialWatcher& watch) {
  return go(person_, task_.intent, trained, seed, task_.limit_s, nullptr, watch);
}

TrialResult Trial::go(const OperatorParameters& person, const Intent& intent,
                      const Training& trained, std::uint64_t seed, double limit_s,
                      double* level_at_goal, const TrialWatcher& watch) {
  const Vec3 goal = intent.path_W.back();
  const Vec3 along = (goal - intent.path_W[intent.path_W.size() - 2]).normalized();
  const int slave_periods = slave_periods_of(place_);
  Operator hand(person, intent, trained, seed_for(seed, 2));
  Handle handle(condition_.device, person.mass, intent.path_W.front());
  AxisVector x = handle.x;
  loop_.start(task_.q_start, x, seed);
  world_.start(task_.q_start);
  Late late(condition_.delay_s / 2);
  ForwardKinematics slave(place_.robot);
  const AxisVector still = AxisVector::Zero(task_.q_start.size());
  const auto tool = static_cast<std::size_t>(place_.tool_link);
  const auto tool_of = [&](const AxisVector& q) -> Vec3 {
    slave.update(q.data(), still.data(), place_.X_WB);
    return slave.p_WL(tool);
  };
  Vec3 p_tool = tool_of(world_.q());
  late.fill(p_tool);

  TrialResult result;
  result.clearance_m = reach_of(place_.distance);
  AxisVector q_led = task_.q_start, qd_led = still;
  Senses senses;
  double done_at = -1;
  for (long k = 0;; ++k) {
    const double time_s = static_cast<double>(k) * period_s;
    senses.handle = handle.x;
    senses.velocity = handle.v;
    senses.seen_tool = late.tool();
    senses.bump = late.bump();
    const Vec3 hand_force = hand.act(time_s, period_s, senses);
    x = handle.x;
    const MasterTick& tick = loop_.master(time_s, x);
    const Vec3 aid_force = tick.aid.head<3>(), reflected = tick.reflected.head<3>();
    if (k % slave_periods == 0) {
      const AxisVector& led = loop_.slave(time_s, world_.tau2());
      qd_led = (led - q_led) / (slave_periods * period_s);
      q_led = led;
      if (!world_.step(q_led, qd_led)) {
        result.blew_up = result.touched = true;
        result.time_s = limit_s;
        return result;
      }
      p_tool = tool_of(world_.q());
      const Contacts& contacts = world_.contacts();
      if (contacts.count > 0) {
        if (!result.touched) result.impact_speed = contacts.closing_speed;
        result.touched = true;
        result.peak_force = std::max(result.peak_force, contacts.force);
      }
      result.overshoot_m = std::max(result.overshoot_m, (p_tool - goal).dot(along));
      if (k / slave_periods % clearance_steps == 0) {
        distance_.look(world_.q().data(), place_.X_WB);
        const NearPoint* const nearest = distance_.nearest();
        if (nearest) result.clearance_m = std::min(result.clearance_m, nearest->distance_m);
      }
    }
    late.show(p_tool, world_.contacts().force / attenuation);
    if (watch) watch(time_s, world_.q());

    const Vec3 last = handle.x;
    senses.felt = aid_force;
    handle.move(hand_force + aid_force + reflected);
    result.effort += hand_force.norm() * period_s;
    result.pushed_j += std::max(0.0, aid_force.dot(handle.x - last));
    if (level_at_goal && (p_tool - goal).norm() < training_reach) {
      *level_at_goal = std::max(*level_at_goal, hand.felt_level());
    }
    if (done_at < 0 && hand.done()) {
      done_at = time_s;
      result.finished = true;
    }
    const bool over =
        (done_at >= 0 && time_s - done_at >= settle_s + condition_.delay_s) || time_s >= limit_s;
    if (!over) continue;
    result.time_s = done_at >= 0 ? done_at : limit_s;
    result.miss_m = (p_tool - goal).norm();
    result.given_j = -loop_.energy().lowest_drag;
    result.given_beyond_device_j = -loop_.energy().lowest;
    return result;
  }
}

}  // namespace vicinity
