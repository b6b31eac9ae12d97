// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Velocity from positions, when the arm gives none: a difference over a window chosen by time.
///
///   x |                        . newest      First-order adaptive windowing (Janabi-Sharifi,
///     |                  . ' |               Hayward & Chen 2000), end-fit: the longest window in
///     |    rest    . ' |                     which a straight line from its oldest to its newest
///     | .  .  .  .                           sample passes all others within the noise band. At
///     +-------------------------- t          rest and in even motion it is long and quiet; where
///         out of the     window              motion begins or turns it shortens by itself.
///         band: not used
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "vicinity/teleop/axes.h"

namespace vicinity {

/// What became of one measurement.
enum class VelocityStatus : std::uint8_t {
  measured,
  started,             ///< the first position: velocity zero
  gap,                 ///< longer than longest_gap_s since the last: velocity zero, started anew
  time_ran_backwards,  ///< velocity zero, started anew
  time_stood_still,    ///< a second position for the same time: left out, the velocity stays
  not_finite,          ///< left out; velocity zero until the next good one
  wrong_size,          ///< as above
};

/// "measured", "started", ...
const char* to_string(VelocityStatus status) noexcept;

struct VelocityOptions {
  /// Longest window [s]. A difference over W lags by W/2 at most: 2 ms here, from rest to motion
  /// and ever after. Where samples are further apart than W, two samples are used nevertheless.
  double longest_window_s = 0.004;
  /// Half-width of the noise band for each axis, shape (n,) [m or rad]: one step of the encoder.
  /// Zero gives the difference of the last two samples, but where motion is even to the last bit.
  Eigen::VectorXd noise_band;
  /// Samples further apart than this have nothing to say about now [s].
  double longest_gap_s = 0.1;
};

/// One for each arm; memory is taken by the constructor. Each axis has its own window.
class VelocityEstimator {
 public:
  /// Samples kept. A window has fewer than that, however fast they come: at 10 kHz 6 ms.
  static constexpr int capacity = 64;

  /// Errors: throws Error for a noise band that is empty, too long, negative or not finite, and for
  /// times that are not positive.
  explicit VelocityEstimator(const VelocityOptions& options);

  /// Takes one sample. Times need not be evenly spaced.
  ///
  /// @param time_s     [s]
  /// @param positions  shape (n,)  [m or rad]; an angle must not wrap around
  /// Real-time: O(n times samples in the window), no allocation.
  VelocityStatus measure(double time_s, const AxisVectorView& positions) noexcept;

  /// The latest velocity, shape (n,) [m/s or rad/s].
  const AxisVector& velocity() const noexcept { return velocity_; }
  /// The shortest window in use over the axes [s]; zero where there is none.
  double window_s() const noexcept { return window_s_; }
  /// The shortest mean time between the samples of a window, over the axes [s]; zero where none.
  double spacing_s() const noexcept { return spacing_s_; }

  /// Forgets all samples.
  void restart() noexcept;

 private:
  VelocityStatus begin(VelocityStatus status, double time_s,
                       const AxisVectorView& positions) noexcept;
  void remember(double time_s, const AxisVectorView& positions) noexcept;
  int slot(int samples_ago) const noexcept { return (newest_ - samples_ago) & (capacity - 1); }

  double longest_window_s_, longest_gap_s_;
  AxisVector noise_band_, velocity_;
  // One column of samples for each axis, as rings.
  Eigen::Matrix<double, capacity, Eigen::Dynamic, 0, capacity, axis_capacity> positions_;
  Eigen::Matrix<double, capacity, 1> times_s_;
  int newest_ = 0, count_ = 0;
  double window_s_ = 0, spacing_s_ = 0;
};

}  // namespace vicinity
