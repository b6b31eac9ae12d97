// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/limiter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "axis_matrix.h"
#include "vicinity/geometry/error.h"
#include "vicinity/teleop/passivity.h"

namespace vicinity {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double positive(double value, const char* what) {
  if (value > 0 && std::isfinite(value)) return value;
  throw Error({.where = "drag limiter",
               .what = std::string(what) + " is not a positive number",
               .found = std::to_string(value)});
}

AxisVector positive(const Eigen::VectorXd& values, Eigen::Index n, const char* what) {
  if (values.size() != n) {
    throw Error({.where = "drag limiter",
                 .what = std::string(what) + " does not fit the axes",
                 .found = std::to_string(values.size()) + " values",
                 .expected = std::to_string(n)});
  }
  for (const double value : values) positive(value, what);
  return values;
}

// W with W B W' = I: the inverse of B's Cholesky factor.
AxisMatrix whitening(const AxisMatrix& matrix) {
  const auto n = matrix.rows();
  return matrix.llt().matrixL().solve(AxisMatrix::Identity(n, n));
}

// How much W D W' may be wrong by rounding, relative to its own norm. Where W is diagonal every
// entry is a product of three; else terms of W D W' may cancel, as far as the condition of B lets
// them.
double whitening_rounding(const AxisMatrix& matrix) {
  const auto n = static_cast<double>(matrix.rows());
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  if (matrix.isDiagonal(0)) return 4 * epsilon;
  const EigenvalueBounds bounds = eigenvalue_bounds(matrix);
  return 4 * n * n * epsilon * bounds.highest / bounds.lowest;
}

// W D W', without Eigen's blocked product, which may ask for memory.
AxisMatrix whitened(const AxisMatrix& whiten, const AxisMatrixView& drag) noexcept {
  const AxisMatrix half = whiten.lazyProduct(drag);
  return half.lazyProduct(whiten.transpose());
}

double upper_bound(const AxisMatrix& matrix, double rounding) noexcept {
  return eigenvalue_bounds(matrix).highest + rounding * matrix.norm();
}

Eigen::VectorXd spread(const std::vector<double>& values, int n) {
  if (values.size() == 1) return Eigen::VectorXd::Constant(n, values.front());
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

const char* to_string(LimiterMode mode) noexcept {
  return mode == LimiterMode::strict ? "strict" : "device";
}

const char* to_string(DragLimit limit) noexcept {
  switch (limit) {
    case DragLimit::none:
      return "none";
    case DragLimit::damping:
      return "damping";
    case DragLimit::mass:
      return "mass";
    case DragLimit::quantisation:
      return "quantisation";
    case DragLimit::force:
      return "force";
    case DragLimit::torque:
      return "torque";
  }
  return "unknown";
}

const char* to_string(LimiterStatus status) noexcept {
  switch (status) {
    case LimiterStatus::limited:
      return "limited";
    case LimiterStatus::deadline_missed:
      return "deadline missed";
    case LimiterStatus::input_stale:
      return "input stale";
    case LimiterStatus::drag_not_passive:
      return "drag not passive";
    case LimiterStatus::not_finite:
      return "not finite";
    case LimiterStatus::wrong_size:
      return "wrong size";
  }
  return "unknown";
}

LimiterOptions limiter_options(const Device& device, LimiterMode mode) {
  const bool strict = mode == LimiterMode::strict;
  const std::vector<double>& damping = strict ? device.physical_damping : device.damping_ceiling;
  if (damping.empty()) {
    throw Error({.where = "device '" + device.name + "'",
                 .what = strict ? "its physical damping is not known, and strict mode rests on it"
                                : "no damping ceiling is known, and device mode rests on it",
                 .hint = strict ? "measuring it and stating physical_damping, or device mode"
                                : "stating damping_ceiling, or strict mode"});
  }
  const int n = device.axis_count;
  LimiterOptions options;
  options.mode = mode;
  options.axes = device.axes;
  options.damping = spread(damping, n).asDiagonal();
  if (!device.mass.empty() && spread(device.mass, n).minCoeff() > 0) {
    options.mass = spread(device.mass, n).asDiagonal();
  }
  if (!device.encoder_step.empty() && !device.dry_friction.empty() &&
      spread(device.dry_friction, n).minCoeff() > 0) {
    options.encoder_step = spread(device.encoder_step, n);
    options.dry_friction = spread(device.dry_friction, n);
  }
  options.force_limit = device.force_limit;
  if (!device.torque_limits.empty()) options.torque_limits = spread(device.torque_limits, n);
  if (device.sample_period) options.period_s = *device.sample_period;
  return options;
}

DragLimiter::DragLimiter(const LimiterOptions& options)
    : mode_(options.mode),
      axes_(options.axes),
      damping_factor_(window_factor(mode_ == LimiterMode::strict ? options.longest_window : 1,
                                    options.longest_hold)),
      mass_limit_(vicinity::mass_limit(options.delay)),
      force_limit_(options.force_limit ? positive(*options.force_limit, "the force limit")
                                       : infinity),
      period_s_(positive(options.period_s, "the sample period")),
      ramp_s_(positive(options.ramp_s, "the ramp time")),
      longest_hold_(options.longest_hold) {
  const AxisMatrix damping =
      checked_axis_matrix(options.damping, "drag limiter: damping", Definiteness::definite);
  const Eigen::Index n = damping.rows();
  if (axes_ == AxisKind::cartesian && n != 3) {
    throw Error({.where = "drag limiter",
                 .what = "a cartesian limiter has three axes",
                 .found = std::to_string(n) + " in the damping matrix",
                 .expected = "3"});
  }
  whiten_damping_ = whitening(damping);
  damping_rounding_ = whitening_rounding(damping);
  if (options.mass.size() > 0) {
    const AxisMatrix mass =
        checked_axis_matrix(options.mass, "drag limiter: mass", Definiteness::definite);
    positive(mass.diagonal(), n, "the mass");
    whiten_mass_ = whitening(mass);
    mass_rounding_ = whitening_rounding(mass);
  }
  if ((options.encoder_step.size() == 0) != (options.dry_friction.size() == 0)) {
    throw Error({.where = "drag limiter",
                 .what = "encoder step and dry friction are only of use together",
                 .found = options.encoder_step.size() > 0 ? "an encoder step alone"
                                                          : "dry friction alone"});
  }
  if (options.encoder_step.size() > 0) {
    encoder_step_ = positive(options.encoder_step, n, "the encoder step");
    dry_friction_ = positive(options.dry_friction, n, "dry friction");
  }
  if (options.torque_limits.size() > 0) {
    torque_limits_ = positive(options.torque_limits, n, "the torque limits");
  }
}

LimiterStatus DragLimiter::judge(const AxisMatrixView& drag, const AxisVectorView& velocity,
                                 const LimiterTick& tick) const noexcept {
  const Eigen::Index n = whiten_damping_.rows();
  if (drag.rows() != n || drag.cols() != n || velocity.size() != n) {
    return LimiterStatus::wrong_size;
  }
  if (!drag.allFinite() || !velocity.allFinite() || !std::isfinite(tick.spacing_s) ||
      !std::isfinite(tick.window_s) || !std::isfinite(tick.handle_force)) {
    return LimiterStatus::not_finite;
  }
  if (tick.deadline_missed) return LimiterStatus::deadline_missed;
  if (tick.held > longest_hold_) return LimiterStatus::input_stale;
  return LimiterStatus::limited;
}

LimiterOutput DragLimiter::limit(const AxisMatrixView& drag, const AxisVectorView& velocity,
                                 const LimiterTick& tick) noexcept {
  ++counts_.ticks;
  LimiterOutput output;
  output.torque = AxisVector::Zero(whiten_damping_.rows());
  const auto nothing = [&](LimiterStatus why) {
    ramp_ = 0;
    counts_.missed_deadlines += why == LimiterStatus::deadline_missed ? 1 : 0;
    counts_.stale += why == LimiterStatus::input_stale ? 1 : 0;
    counts_.refused += why >= LimiterStatus::drag_not_passive ? 1 : 0;
    output.status = why;
    output.scale = output.ramp = output.given = output.power_given = 0;
    output.torque.setZero();
    return output;
  };

  output.status = judge(drag, velocity, tick);
  if (output.status == LimiterStatus::wrong_size || output.status == LimiterStatus::not_finite) {
    return nothing(output.status);
  }
  const AxisVector asked = drag.lazyProduct(velocity);
  output.asked = asked.norm();
  output.power_asked = velocity.dot(asked);
  if (output.status != LimiterStatus::limited) return nothing(output.status);

  // Rule 4 is about 0 <= D <= c B: a D that rounding alone keeps from being symmetric or
  // semidefinite is a drag, another one is a mistake upstream.
  const AxisMatrix relative = whitened(whiten_damping_, drag);
  const EigenvalueBounds bounds = eigenvalue_bounds(relative);
  const double slack = 1e-9 * std::max(bounds.highest, -bounds.lowest);
  const double asymmetry = (relative - relative.transpose()).cwiseAbs().maxCoeff();
  if (!(bounds.lowest >= -slack) || !(asymmetry <= slack)) {
    return nothing(std::isfinite(slack) ? LimiterStatus::drag_not_passive
                                        : LimiterStatus::not_finite);
  }
  output.rho = bounds.highest + damping_rounding_ * relative.norm() +
               static_cast<double>(relative.rows()) * asymmetry;

  double scale = 1;
  const auto at_most = [&](double limit, DragLimit reason) {
    if (!(limit < scale)) return;
    scale = limit;
    output.limit = reason;
  };
  const double spacing_s = tick.spacing_s > 0 ? tick.spacing_s : period_s_;
  const double window_s = tick.window_s > 0 ? tick.window_s : spacing_s;
  if (output.rho > 0) {
    const bool strict = mode_ == LimiterMode::strict;
    const double evenness = strict ? std::min(1.0, spacing_s / period_s_) : 1;
    const bool plain_difference = window_s < 1.5 * spacing_s;
    at_most(damping_factor_ * (plain_difference ? std::sqrt(evenness) : evenness) / output.rho,
            DragLimit::damping);
  }
  if (whiten_mass_.size() > 0) {
    const AxisMatrix per_mass = whitened(whiten_mass_, drag);
    // The trace bounds the largest eigenvalue: where it will do, nothing more is needed.
    if (period_s_ * per_mass.trace() > 0.5 * mass_limit_) {
      at_most(mass_limit_ / (period_s_ * upper_bound(per_mass, mass_rounding_)), DragLimit::mass);
    }
  }
  if (encoder_step_.size() > 0) {
    // One step on every axis at once, the worst signs: sum_j |D_ij| Delta_j / window against f_i.
    for (Eigen::Index i = 0; i < encoder_step_.size(); ++i) {
      const double answer = drag.row(i).cwiseAbs().dot(encoder_step_);
      if (answer > 0) at_most(dry_friction_[i] * window_s / answer, DragLimit::quantisation);
    }
  }
  const double force = axes_ == AxisKind::cartesian ? output.asked : tick.handle_force;
  if (force > 0) at_most(force_limit_ / force, DragLimit::force);
  for (Eigen::Index i = 0; i < torque_limits_.size(); ++i) {
    if (asked[i] != 0) at_most(torque_limits_[i] / std::abs(asked[i]), DragLimit::torque);
  }

  ramp_ = std::min(1.0, ramp_ + std::min(spacing_s, period_s_) / ramp_s_);
  output.ramp = ramp_;
  output.scale = ramp_ * scale;
  output.torque = -output.scale * asked;
  output.power_given = -output.torque.dot(velocity);
  output.given = output.torque.norm();
  if (!output.torque.allFinite()) return nothing(LimiterStatus::not_finite);
  // D is semidefinite but for rounding, which can still turn v'Dv where v lies in D's null space.
  if (!(output.power_given >= 0)) {
    output.torque.setZero();
    output.given = output.power_given = 0;
  }
  counts_.limited += output.limit != DragLimit::none ? 1 : 0;
  return output;
}

}  // namespace vicinity
