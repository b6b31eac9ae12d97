// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/operator.h"

#include <algorithm>
#include <cmath>

namespace vicinity {
namespace {

constexpr double never = -1;

// Least jerk from 0 to 1, and its rate (Flash & Hogan 1985).
double least_jerk(double s) noexcept { return s * s * s * (10 + s * (6 * s - 15)); }
double least_jerk_rate(double s) noexcept { return 30 * s * s * (1 + s * (s - 2)); }

}  // namespace

Operator::Operator(const OperatorParameters& parameters, const Intent& intent,
                   const Training& trained, std::uint64_t seed)
    : parameters_(parameters), intent_(intent), trained_(trained), noise_(seed) {
  const double along = parameters.depth_error_m * noise_.normal();
  for (int axis = 0; axis < 3; ++axis) {
    aim_error_[axis] = parameters.across_error_m * noise_.normal();
  }
  const Vec3 sight = intent.sight_W.normalized();
  aim_error_ += (along - aim_error_.dot(sight)) * sight;
  const double where = noise_.uniform(), error = noise_.normal();
  const auto& range =
      trained.cue == Cue::force ? parameters.force_weber : parameters.viscosity_weber;
  weber_ = range[0] + where * (range[1] - range[0]);
  const double spread =
      trained.cue == Cue::force ? parameters.force_spread : parameters.viscosity_spread;
  stop_level_ = trained.level * std::exp(spread * error);
  clear_level_ = stop_level_ * std::exp(-spread);
  reference_ = trained.cue == Cue::force ? parameters.least_force : parameters.own_resistance;
  if (trained.cue == Cue::viscosity) level_ = parameters.own_resistance;
  // Too little to be told from nothing is not gone by.
  if (trained.level < reference_ * (1 + weber_)) stop_level_ = clear_level_ = 0;
}

Vec3 Operator::act(double time_s, double period_s, const Senses& senses) noexcept {
  if (!started_) {
    started_ = true;
    wanted_ = senses.handle;
    leg_ = 1;
    plan(time_s, senses.handle,
         intent_.path_W[1] + (intent_.path_W.size() == 2 ? aim_error_ : Vec3::Zero().eval()),
         intent_.speed);
  }
  feel(time_s, period_s, senses);
  heed(time_s);
  move_on(time_s, period_s, senses);
  return parameters_.stiffness * (wanted_ + strayed_ - senses.handle) +
         parameters_.damping * (wanted_rate_ - senses.velocity);
}

void Operator::plan(double time_s, const Vec3& from, const Vec3& to, double speed) noexcept {
  from_ = from;
  to_ = to;
  phase_ = 0;
  duration_s_ = std::max((to - from).norm() / speed, 0.2);
  wait_until_s_ = time_s;
}

void Operator::feel(double time_s, double period_s, const Senses& senses) noexcept {
  const double speed = senses.velocity.norm();
  double now = level_;
  if (trained_.cue == Cue::force) {
    now = senses.felt.norm();
  } else if (trained_.cue == Cue::viscosity && speed > parameters_.slowest_felt) {
    const double against = std::max(0.0, -senses.felt.dot(senses.velocity) / speed);
    now = parameters_.own_resistance + (against > parameters_.least_force ? against / speed : 0.0);
  }
  level_ += (now - level_) * std::min(1.0, period_s / parameters_.felt_over_s);
  if (trained_.cue == Cue::none) return;
  if (level_ > reference_ * (1 + weber_)) {
    reference_ = level_;
    if (notices_at_s_ < 0) notices_at_s_ = time_s + parameters_.touch_reaction_s;
    ++pending_;
  } else if (level_ < reference_ / (1 + weber_) &&
             level_ > (trained_.cue == Cue::force ? parameters_.least_force : 0.0)) {
    reference_ = level_;
    if (notices_at_s_ < 0) notices_at_s_ = time_s + parameters_.touch_reaction_s;
    --pending_;
  }
  // Who creeps on against what he sees stops as soon as he is no longer sure that it is less.
  const double enough = creeping_ ? clear_level_ : stop_level_;
  const bool as_trained = intent_.stops_by_feel && stop_level_ > 0 && level_ >= enough;
  const bool bumped = senses.bump > parameters_.bump;
  if (stops_at_s_ < 0 && (as_trained || bumped)) {
    stops_at_s_ = time_s + parameters_.touch_reaction_s;
  }
}

// What was noticed a reaction time ago takes effect.
void Operator::heed(double time_s) noexcept {
  if (notices_at_s_ >= 0 && time_s >= notices_at_s_) {
    notices_at_s_ = never;
    rises_ = std::max(0, rises_ + pending_);
    pending_ = 0;
    if (intent_.careful) {
      pace_ = std::max(parameters_.least_pace, std::pow(parameters_.caution, rises_));
    }
  }
  if (stops_at_s_ >= 0 && time_s >= stops_at_s_ && !stopped_) stop(wanted_);
}

void Operator::stop(const Vec3& at) noexcept {
  stopped_ = done_ = true;
  wanted_ = at;
  wanted_rate_.setZero();
}

void Operator::move_on(double time_s, double period_s, const Senses& senses) noexcept {
  if (stopped_) return;
  if (phase_ < 1 && time_s >= wait_until_s_) {
    phase_ = std::min(1.0, phase_ + pace_ * period_s / duration_s_);
    wanted_ = from_ + least_jerk(phase_) * (to_ - from_);
    wanted_rate_ = least_jerk_rate(phase_) * pace_ / duration_s_ * (to_ - from_);
    // Noise of execution: correlated, as large as the wanted speed makes it. It is not known to him
    // but by sight, so that it stays until he corrects it.
    const double share = period_s / parameters_.noise_correlation_s;
    for (int axis = 0; axis < 3; ++axis) {
      tremble_[axis] += -share * tremble_[axis] + std::sqrt(2 * share) * noise_.normal();
    }
    strayed_ += parameters_.noise * wanted_rate_.norm() * period_s * tremble_;
    if (phase_ < 1) return;
    wanted_rate_.setZero();
    const bool more = leg_ + 1 < intent_.path_W.size();
    if (more) {
      ++leg_;
      const bool last = leg_ + 1 == intent_.path_W.size();
      const Vec3 next = intent_.path_W[leg_] + (last ? aim_error_ : Vec3::Zero().eval());
      plan(time_s, wanted_, next, intent_.speed);
      return;
    }
    // There, as planned. Is it so? The picture comes late, and so does the eye.
    wait_until_s_ = time_s + parameters_.sight_reaction_s;
    return;
  }
  if (phase_ < 1 || time_s < wait_until_s_ || done_) return;
  if (creeping_) {
    stop(wanted_);
    return;
  }
  const Vec3 missing = intent_.path_W.back() + aim_error_ - senses.seen_tool;
  if (missing.norm() > parameters_.tolerance_m && corrections_ < parameters_.most_corrections) {
    ++corrections_;
    plan(time_s, wanted_, wanted_ + missing, intent_.speed);
    return;
  }
  const bool waits_for_feel = intent_.stops_by_feel && level_ < clear_level_ && stops_at_s_ < 0;
  if (waits_for_feel) {
    creeping_ = true;
    const Vec3 along = (intent_.path_W.back() - intent_.path_W[intent_.path_W.size() - 2]);
    plan(time_s, wanted_,
         wanted_ + parameters_.creep_most * parameters_.depth_error_m * along.normalized(),
         parameters_.creep_speed);
    return;
  }
  done_ = true;
}

}  // namespace vicinity
