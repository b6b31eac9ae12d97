// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A joint log as a smooth motion that can be asked at any time.
#pragma once

#include "replay/joint_log.h"
#include "vicinity/teleop/axes.h"

namespace vicinity::cli {

/// Positions run along one cubic a stretch between two samples (Hermite), whose slope at a sample
/// is that of the parabola through it and its neighbours: continuous in position and velocity,
/// through every sample, exact for parabolas. Recorded velocities run straight between samples.
///
/// Behind its end the motion runs back along the same way, and at its beginning forward again.
class JointTrajectory {
 public:
  /// @param log  at least two samples, rising in time
  explicit JointTrajectory(JointLog log);

  const JointLog& log() const noexcept { return log_; }
  double length_s() const noexcept { return log_.t.back() - log_.t.front(); }
  bool has_velocities() const noexcept { return log_.qd.size() > 0; }

  /// @param time_s  since the first sample, >= 0                [s]
  /// @param q       out, positions, shape (joints,)             [rad or m]
  /// @param qd      out, recorded velocities, same shape; zero where the log has none
  /// Real-time: O(log samples), no allocation.
  void at(double time_s, AxisVector& q, AxisVector& qd) const noexcept;

 private:
  JointLog log_;
  Eigen::MatrixXd slope_;  // dq/dt at the samples, shape (joints, samples)
};

}  // namespace vicinity::cli
