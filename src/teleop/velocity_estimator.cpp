// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/velocity_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

double positive_seconds(double value, const char* what) {
  if (value > 0 && std::isfinite(value)) return value;
  throw Error({.where = "velocity estimator",
               .what = std::string(what) + " is not a positive number of seconds",
               .found = std::to_string(value)});
}

const Eigen::VectorXd& checked_band(const Eigen::VectorXd& band) {
  if (band.size() == 0 || band.size() > axis_capacity) {
    throw Error({.where = "velocity estimator",
                 .what = "the noise band does not tell how many axes there are",
                 .found = std::to_string(band.size()) + " values",
                 .expected = "one for each of 1 to " + std::to_string(axis_capacity) + " axes"});
  }
  if (!band.allFinite() || band.minCoeff() < 0) {
    throw Error({.where = "velocity estimator",
                 .what = "the noise band is not a width",
                 .expected = "finite values of zero or more"});
  }
  return band;
}

}  // namespace

const char* to_string(VelocityStatus status) noexcept {
  switch (status) {
    case VelocityStatus::measured:
      return "measured";
    case VelocityStatus::started:
      return "started";
    case VelocityStatus::gap:
      return "gap";
    case VelocityStatus::time_ran_backwards:
      return "time ran backwards";
    case VelocityStatus::time_stood_still:
      return "time stood still";
    case VelocityStatus::not_finite:
      return "not finite";
    case VelocityStatus::wrong_size:
      return "wrong size";
  }
  return "unknown";
}

VelocityEstimator::VelocityEstimator(const VelocityOptions& options)
    : longest_window_s_(positive_seconds(options.longest_window_s, "the longest window")),
      longest_gap_s_(positive_seconds(options.longest_gap_s, "the longest gap")),
      noise_band_(checked_band(options.noise_band)),
      velocity_(AxisVector::Zero(options.noise_band.size())) {
  positions_.setZero(capacity, noise_band_.size());
  times_s_.setZero();
}

void VelocityEstimator::restart() noexcept {
  count_ = 0;
  velocity_.setZero();
  window_s_ = spacing_s_ = 0;
}

void VelocityEstimator::remember(double time_s, const AxisVectorView& positions) noexcept {
  newest_ = (newest_ + 1) & (capacity - 1);
  count_ = std::min(count_ + 1, capacity);
  times_s_[newest_] = time_s;
  positions_.row(newest_) = positions.transpose();
}

VelocityStatus VelocityEstimator::begin(VelocityStatus status, double time_s,
                                        const AxisVectorView& positions) noexcept {
  restart();
  remember(time_s, positions);
  return status;
}

VelocityStatus VelocityEstimator::measure(double time_s, const AxisVectorView& positions) noexcept {
  if (positions.size() != velocity_.size() || !std::isfinite(time_s) || !positions.allFinite()) {
    velocity_.setZero();
    return positions.size() != velocity_.size() ? VelocityStatus::wrong_size
                                                : VelocityStatus::not_finite;
  }
  if (count_ == 0) return begin(VelocityStatus::started, time_s, positions);
  const double elapsed_s = time_s - times_s_[newest_];
  if (elapsed_s == 0) return VelocityStatus::time_stood_still;
  if (elapsed_s < 0) return begin(VelocityStatus::time_ran_backwards, time_s, positions);
  if (elapsed_s > longest_gap_s_) return begin(VelocityStatus::gap, time_s, positions);
  remember(time_s, positions);

  // Time stamps are rounded: a window that ends on a sample must not lose it by that.
  const double longest_s = longest_window_s_ * (1 + 1e-9);
  window_s_ = spacing_s_ = std::numeric_limits<double>::infinity();
  for (Eigen::Index axis = 0; axis < velocity_.size(); ++axis) {
    const double newest = positions_(newest_, axis), band = noise_band_[axis];
    // Slopes of the lines through the newest sample that pass all samples so far within the band.
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    double slope = 0, window_s = 0;
    int used = 0;
    for (int ago = 1; ago < count_; ++ago) {
      const double before_s = time_s - times_s_[slot(ago)];
      if (ago > 1 && before_s > longest_s) break;
      const double way = newest - positions_(slot(ago), axis);
      const double line = way / before_s;
      if (line < lowest || line > highest) break;
      slope = line;
      window_s = before_s;
      used = ago;
      lowest = std::max(lowest, (way - band) / before_s);
      highest = std::min(highest, (way + band) / before_s);
    }
    velocity_[axis] = slope;
    window_s_ = std::min(window_s_, window_s);
    spacing_s_ = std::min(spacing_s_, window_s / used);
  }
  return VelocityStatus::measured;
}

}  // namespace vicinity
