// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/joint_trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vicinity::cli {

JointTrajectory::JointTrajectory(JointLog log) : log_(std::move(log)), slope_(log_.q) {
  const Eigen::Index last = log_.q.cols() - 1;
  const auto interval = [&](Eigen::Index n) {
    return log_.t[static_cast<std::size_t>(n + 1)] - log_.t[static_cast<std::size_t>(n)];
  };
  const auto secant = [&](Eigen::Index n) -> Eigen::VectorXd {
    return (log_.q.col(n + 1) - log_.q.col(n)) / interval(n);
  };
  if (last == 1) {
    slope_.col(0) = slope_.col(1) = secant(0);
    return;
  }
  for (Eigen::Index n = 1; n < last; ++n) {
    const double before = interval(n - 1), after = interval(n);
    slope_.col(n) = (after * secant(n - 1) + before * secant(n)) / (before + after);
  }
  // The same parabolas at the ends: slopes of a parabola add up to twice the secant between them.
  slope_.col(0) = 2 * secant(0) - slope_.col(1);
  slope_.col(last) = 2 * secant(last - 1) - slope_.col(last - 1);
}

void JointTrajectory::at(double time_s, AxisVector& q, AxisVector& qd) const noexcept {
  const double there_and_back = std::fmod(time_s, 2 * length_s());
  const bool back = there_and_back > length_s();
  const double t = log_.t.front() + (back ? 2 * length_s() - there_and_back : there_and_back);
  const auto next = std::upper_bound(log_.t.begin() + 1, log_.t.end() - 1, t);
  const auto n = static_cast<Eigen::Index>(next - log_.t.begin()) - 1;
  const double h = *next - *(next - 1);
  const double s = std::clamp((t - *(next - 1)) / h, 0.0, 1.0), r = 1 - s;
  q = (r * r * (1 + 2 * s)) * log_.q.col(n) + (s * s * (1 + 2 * r)) * log_.q.col(n + 1) +
      (h * s * r * r) * slope_.col(n) - (h * s * s * r) * slope_.col(n + 1);
  if (has_velocities()) {
    qd = r * log_.qd.col(n) + s * log_.qd.col(n + 1);
    if (back) qd = -qd;
  } else {
    qd.setZero(q.size());
  }
}

}  // namespace vicinity::cli
