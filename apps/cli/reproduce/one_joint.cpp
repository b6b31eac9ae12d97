// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/one_joint.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <deque>

namespace vicinity::report {
namespace {

// exp(A T) of the joint's own motion. A T is far below one, so that the series is exact to rounding
// in a few terms.
Eigen::Matrix2d transition(const JointSetting& s) {
  Eigen::Matrix2d a;
  a << 0, 1, -s.grip_stiffness / s.mass, -(s.damping + s.grip_damping) / s.mass;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Identity(), term = sum;
  for (int n = 1; n <= 20; ++n) {
    term = term * a * (s.period / n);
    sum += term;
  }
  return sum;
}

}  // namespace

JointRun simulate(const JointSetting& setting, const Feedback& feedback, const Target& target,
                  double x, double v, double duration) {
  // Slower than this is rest: a sign of the velocity means nothing there.
  constexpr double rest = 1e-4;
  const Eigen::Matrix2d step = transition(setting);
  Eigen::Vector2d state(x, v);
  std::deque<double> positions(static_cast<std::size_t>(setting.delay) + 2, x - v * setting.period);
  positions.back() = x;
  JointRun run;
  double direction = 0;
  const auto periods = static_cast<int>(std::lround(duration / setting.period));
  for (int k = 0; k < periods; ++k) {
    const double seen = positions[1];
    const double seen_velocity = (positions[1] - positions[0]) / setting.period;
    const double force = feedback(seen, seen_velocity);
    const double t = k * setting.period;
    run.instants.push_back({t, state.x(), state.y(), force});
    // With force and target held, the joint moves about this point.
    const Eigen::Vector2d rest_at(target(t) + force / setting.grip_stiffness, 0);
    const Eigen::Vector2d next = step * (state - rest_at) + rest_at;
    const double work = force * (next.x() - state.x());
    (work > 0 ? run.put_in : run.taken_out) += std::abs(work);
    run.gain = std::max(run.gain, run.put_in - run.taken_out);
    state = next;
    if (std::abs(state.y()) > rest) {
      if (direction * state.y() < 0) ++run.reversals;
      direction = state.y();
    }
    run.contact = std::abs(state.x()) > setting.wall;
    if (run.contact) {
      run.instants.push_back({t + setting.period, state.x(), state.y(), force});
      break;
    }
    positions.push_back(state.x());
    positions.pop_front();
  }
  double least = INFINITY, most = -INFINITY;
  for (std::size_t n = run.instants.size() * 3 / 4; n < run.instants.size(); ++n) {
    least = std::min(least, run.instants[n].x);
    most = std::max(most, run.instants[n].x);
    run.final_force = std::max(run.final_force, std::abs(run.instants[n].force));
  }
  run.ripple = most - least;
  return run;
}

}  // namespace vicinity::report
