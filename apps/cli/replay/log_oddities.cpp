// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/log_oddities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vicinity::cli {
namespace {

// Longer than this many usual periods, samples are missing.
constexpr double gap_periods = 5;
// No logger of a moving arm is slower than this [Hz].
constexpr double slow_rate = 5;
// Differences of neighbouring samples are noisy: only this many times the limit is odd.
constexpr double speed_slack = 10;

const Joint& joint_of(const RobotModel& robot, Eigen::Index coordinate) {
  return robot
      .joints[static_cast<std::size_t>(robot.coordinates[static_cast<std::size_t>(coordinate)])];
}

double usual_period(const std::vector<double>& t) {
  std::vector<double> periods;
  for (std::size_t n = 1; n < t.size(); ++n) periods.push_back(t[n] - t[n - 1]);
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

}  // namespace

void unwrap_continuous_joints(const RobotModel& robot, JointLog& log) {
  constexpr double turn = 2 * std::numbers::pi;
  for (Eigen::Index c = 0; c < log.q.rows(); ++c) {
    if (joint_of(robot, c).type != JointType::continuous) continue;
    int wraps = 0;
    double shift = 0, last = log.q(c, 0);
    for (Eigen::Index n = 1; n < log.q.cols(); ++n) {
      const double turns = std::round((log.q(c, n) - last) / turn);
      last = log.q(c, n);
      wraps += turns != 0 ? 1 : 0;
      shift -= turns * turn;
      log.q(c, n) += shift;
    }
    if (wraps > 0) {
      log.remarks.push_back(fmt::format("joint '{}' wraps around {} {}; whole turns were put back",
                                        joint_of(robot, c).name, wraps,
                                        wraps == 1 ? "time" : "times"));
    }
  }
}

void remark_on_times(const std::vector<std::size_t>& lines, bool converted, JointLog& log) {
  const double period = usual_period(log.t);
  if (1 / period < slow_rate) {
    log.remarks.push_back(
        fmt::format("the log has one sample every {:.4g} s{}", period,
                    converted ? ", which is seldom; the motion between them is a guess"
                              : ": is its time in milliseconds? Then say t=COLUMN*0.001 in "
                                "--columns"));
  }
  std::size_t gaps = 0, longest = 1;
  for (std::size_t n = 1; n < log.t.size(); ++n) {
    gaps += log.t[n] - log.t[n - 1] > gap_periods * period ? 1 : 0;
    if (log.t[n] - log.t[n - 1] > log.t[longest] - log.t[longest - 1]) longest = n;
  }
  if (gaps > 0) {
    log.remarks.push_back(fmt::format(
        "the log has {} {}, the longest of {:.3g} s before line {}; the motion across is a guess",
        gaps, gaps == 1 ? "gap" : "gaps", log.t[longest] - log.t[longest - 1], lines[longest]));
  }
}

void remark_on_motion(const RobotModel& robot, JointLog& log) {
  for (Eigen::Index c = 0; c < log.q.rows(); ++c) {
    const Joint& joint = joint_of(robot, c);
    const char* unit = joint.type == JointType::prismatic ? "m" : "rad";
    const double low = log.q.row(c).minCoeff(), high = log.q.row(c).maxCoeff();
    if (low < joint.limits.lower || high > joint.limits.upper) {
      const bool degrees = std::max(-low, high) > 4 * std::numbers::pi;
      log.remarks.push_back(
          fmt::format("joint '{}' goes from {:.4g} to {:.4g} {}, beyond its limits {:.4g} to {:.4g}"
                      "{}",
                      joint.name, low, high, unit, joint.limits.lower, joint.limits.upper,
                      degrees ? ": are these degrees? Then say *0.0174533 in --columns" : ""));
    }
    double fastest = 0;
    for (Eigen::Index n = 1; n < log.q.cols(); ++n) {
      const auto k = static_cast<std::size_t>(n);
      fastest =
          std::max(fastest, std::abs(log.q(c, n) - log.q(c, n - 1)) / (log.t[k] - log.t[k - 1]));
    }
    if (fastest > speed_slack * joint.limits.velocity && joint.limits.velocity > 0) {
      log.remarks.push_back(
          fmt::format("joint '{}' moves at up to {:.3g} {}/s, its limit is {:.3g}", joint.name,
                      fastest, unit, joint.limits.velocity));
    }
  }
}

}  // namespace vicinity::cli
