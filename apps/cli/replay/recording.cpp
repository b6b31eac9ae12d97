// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/recording.h"

#include <algorithm>

namespace vicinity::cli {

Recording::Recording(std::size_t capacity, std::size_t joints)
    : ticks_(capacity),
      torques_(capacity * joints),
      positions_(capacity * joints),
      joints_(joints) {}

void Recording::add(double time_s, const double* q, const Output& output, double late_us,
                    double tick_us) noexcept {
  if (size_ == ticks_.size()) return;
  TickRecord& tick = ticks_[size_];
  tick.time_s = time_s;
  tick.tool = output.tool;
  tick.master_force = output.master_force;
  tick.reason = output.reason;
  const bool limited = output.limiter.torque.size() > 0;  // there is a limiter, and it was asked
  tick.scale = limited ? output.limiter.scale : 1;
  tick.points_felt = output.counts.points_felt;
  tick.tick_us = static_cast<float>(tick_us);
  tick.late_us = static_cast<float>(late_us);
  tick.status = output.status;
  tick.limit = output.limiter.limit;
  std::copy_n(output.torque.data(), joints_, &torques_[size_ * joints_]);
  std::copy_n(q, joints_, &positions_[size_ * joints_]);
  energy_ = output.energy;
  ++size_;
}

}  // namespace vicinity::cli
