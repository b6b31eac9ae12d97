// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The exact energy account of the drag, kept at run time (stability rule 8).
#pragma once

#include <cmath>
#include <cstdint>

#include "vicinity/teleop/axes.h"

namespace vicinity {

/// What became of one record.
enum class AuditStatus : std::uint8_t {
  recorded,
  started,     ///< the first position: nothing to compare with yet
  not_finite,  ///< a position, force or time that is no number: the way there cannot be accounted
  wrong_size,  ///< not as many values as axes: as above
  time_did_not_advance,  ///< moved in no time, or time ran backwards: as above
};

/// "recorded", "started", ...
const char* to_string(AuditStatus status) noexcept;

/// Sum that does not lose small terms beside a large total (Neumaier's compensated summation): its
/// error does not grow with the number of terms.
class EnergySum {
 public:
  void add(double term) noexcept {
    const double sum = sum_ + term;
    lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - sum) + term : (term - sum) + sum_;
    sum_ = sum;
    size_ += std::abs(term);
  }
  double value() const noexcept { return sum_ + lost_; }
  /// Sum of the sizes of all terms: what rounding is measured against.
  double size() const noexcept { return size_; }

 private:
  double sum_ = 0, lost_ = 0, size_ = 0;
};

/// Where the account stands.
struct EnergyBalance {
  double drag = 0;         ///< E: what the drag has taken out of the motion           [J]
  double device = 0;       ///< what the device's own damping has taken out, at least  [J]
  double lowest = 0;       ///< the lowest that drag + device ever was                 [J]
  double lowest_drag = 0;  ///< the lowest that drag alone ever was               [J]
  /// Whether drag + device was never below zero by more than the rounding of the sums: no operator,
  /// however clever, has got out energy that he had not put in.
  bool passive = true;
  std::uint64_t records = 0;      ///< periods in the account
  std::uint64_t unaccounted = 0;  ///< periods that are missing in it
};

/// Adds up, over every period in which a force was held,
///
///   E      += -F_{k-1}'(x_k - x_{k-1})                             exact: F was constant
///   device += (x_k - x_{k-1})' B_phys (x_k - x_{k-1}) / (t_k - t_{k-1})
///
/// The second is a lower bound of what the damping really took: for a given way in a given time, an
/// even motion costs least. Periods need not be alike.
///
/// The account is exact if each force given to record() acts from then until the next record(),
/// scaled by nobody. It is about the torques and the positions they act on: pair the master's with
/// the master's.
class EnergyAudit {
 public:
  /// @param damping  B_phys, symmetric and positive semidefinite, shape (n,n) [N·s/m or N·m·s/rad];
  ///                 zero where it is not known: then `passive` asks more than is needed
  /// Errors: throws Error for a matrix that is not such, or has more than axis_capacity rows.
  explicit EnergyAudit(const Eigen::MatrixXd& damping);

  /// Closes the period since the last record and opens the next.
  ///
  /// @param time_s     t_k                                            [s]
  /// @param positions  x_k, shape (n,)                                [m or rad]
  /// @param force      F_k, what acts from now on, shape (n,)         [N or N·m]
  /// Input that cannot be accounted closes nothing: the account starts anew with the next good one,
  /// keeping its sums, and the period counts as unaccounted.
  /// Real-time: O(n²), no allocation.
  AuditStatus record(double time_s, const AxisVectorView& positions,
                     const AxisVectorView& force) noexcept;

  const EnergyBalance& balance() const noexcept { return balance_; }

  /// Empties the account.
  void reset() noexcept;

 private:
  AuditStatus lose(AuditStatus why) noexcept;

  AxisMatrix damping_;
  AxisVector position_, force_;
  double time_s_ = 0;
  bool open_ = false;
  EnergySum drag_, device_;
  EnergyBalance balance_;
};

}  // namespace vicinity
