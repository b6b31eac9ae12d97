// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Keeps the drag within what the device can render without feeding its motion.
///
///   D, v^ ->  s = ramp * min(1, damping, mass, quantisation, force, torque)  ->  -s D v^
///
/// Everything is scaled by one number and nothing is ever added: the direction stays that of the
/// drag, and tau . v^ <= 0 in every tick, whatever comes in.
#pragma once

#include <cstdint>
#include <optional>

#include "vicinity/teleop/axes.h"
#include "vicinity/teleop/device.h"

namespace vicinity {

/// What the drag is measured against.
enum class LimiterMode : std::uint8_t {
  strict,  ///< the device's own damping: provably passive, whatever the field, the arm, the memory
           ///< and the operator do (stability rule 4)
  device,  ///< a ceiling known from practice, several times higher; not proven
};

/// What held the drag down most. In the order of the formula.
enum class DragLimit : std::uint8_t {
  none,
  damping,       ///< rules 2-5: D against B_phys or the ceiling
  mass,          ///< rule 6: nobody holding
  quantisation,  ///< rule 7: one encoder step against dry friction
  force,         ///< norm of the force at the handle
  torque,        ///< some joint's torque
};

/// Why a tick's force is what it is. All but `limited` give zero force and start the ramp anew.
enum class LimiterStatus : std::uint8_t {
  limited,           ///< s D is in the output, s = 1 included
  deadline_missed,   ///< the caller said so
  input_stale,       ///< the velocity has been used for longest_hold periods already
  drag_not_passive,  ///< D is not symmetric positive semidefinite: not a drag
  not_finite,        ///< a number that is none
  wrong_size,        ///< not as many rows as axes
};

const char* to_string(LimiterMode mode) noexcept;
const char* to_string(DragLimit limit) noexcept;
const char* to_string(LimiterStatus status) noexcept;

/// What is empty is not known, and does not limit.
struct LimiterOptions {
  LimiterMode mode = LimiterMode::strict;
  AxisKind axes = AxisKind::cartesian;

  /// `strict`: B_phys, the device's own damping; `device`: its ceiling. Symmetric positive
  /// definite, shape (n,n) [N·s/m or N·m·s/rad].
  Eigen::MatrixXd damping;
  /// Lower bound of the device's inertia: symmetric positive definite, shape (n,n) [kg or kg·m²].
  Eigen::MatrixXd mass;
  /// Delta and f_c for each axis, shape (n,); both or neither.
  Eigen::VectorXd encoder_step, dry_friction;

  /// On |F| at the handle [N]. Cartesian: of the output. Joints: of LimiterTick::handle_force.
  std::optional<double> force_limit;
  /// On each |tau_i|, shape (n,) [N·m].
  Eigen::VectorXd torque_limits;

  double period_s = 0.001;  ///< T: the longest period that still counts as on time
  int delay = 0;            ///< d: whole periods between measuring and commanding
  int longest_hold = 1;     ///< N of rule 5: periods for which one force may go on acting
  /// Periods that v^ averages over at most, where their number varies (VelocityEstimator); 1 where
  /// it is fixed, however large. See window_factor(). `strict` only: a ceiling comes with a filter.
  int longest_window = 1;
  double ramp_s = 0.1;  ///< from zero to full force after a drop: a drop is felt, a jump too
};

/// Options for a device. `strict` takes its physical damping, `device` its ceiling.
/// Errors: throws Error where the device does not state what the mode needs.
LimiterOptions limiter_options(const Device& device, LimiterMode mode);

/// What one tick knows beside drag and velocity.
struct LimiterTick {
  bool deadline_missed = false;
  /// Periods this velocity has been in use, this one included: 1 is fresh.
  int held = 1;
  /// Mean time between the samples that v^ came from, the shortest over the axes [s]; zero: T.
  ///
  /// A force made in a short period may act in a long one, so that c shrinks. With
  /// y_k = (x_k - x_{k-1})/sqrt(dt_k) the damping eats b y_k² a period, and a plain difference
  /// feeds B sqrt(dt_{k+1}/dt_k) y_k y_{k+1}: sqrt(dt_k/T) of c is enough. A longer window mixes
  /// periods, and takes dt/T. `strict` only.
  double spacing_s = 0;
  /// Time between the samples of v^, the shortest over the axes [s]; zero: spacing_s.
  double window_s = 0;
  /// Joints: norm of the force at the handle that -D v^ amounts to [N]; zero: none stated.
  double handle_force = 0;
};

struct LimiterOutput {
  LimiterStatus status = LimiterStatus::limited;
  AxisVector torque;  ///< -s D v^, shape (n,)                                [N or N·m]
  double scale = 0;   ///< s, 0..1, ramp included
  double ramp = 0;    ///< 0..1
  DragLimit limit = DragLimit::none;
  double rho = 0;          ///< largest eigenvalue of B^-1/2 D B^-1/2, or a little more, never less
  double asked = 0;        ///< |D v^|                                             [N or N·m]
  double given = 0;        ///< |torque|                                           [N or N·m]
  double power_asked = 0;  ///< v^' D v^                                           [W]
  double power_given = 0;  ///< -torque . v^, never below zero                     [W]
};

/// How often the force was zero for a reason.
struct LimiterCounts {
  std::uint64_t ticks = 0, limited = 0, missed_deadlines = 0, stale = 0, refused = 0;
};

/// One for each device; memory is taken by the constructor.
class DragLimiter {
 public:
  /// Errors: throws Error for options that do not fit together, matrices that are not positive
  /// definite, and what is not a positive number.
  explicit DragLimiter(const LimiterOptions& options);

  LimiterMode mode() const noexcept { return mode_; }
  int axis_count() const noexcept { return static_cast<int>(whiten_damping_.rows()); }
  /// c: what rho may be at most (rule 5, and the window's share).
  double damping_factor() const noexcept { return damping_factor_; }
  const LimiterCounts& counts() const noexcept { return counts_; }

  /// Scales one tick's drag.
  ///
  /// @param drag      D = sum mu S J' P J, symmetric positive semidefinite, shape (n,n)
  /// @param velocity  v^, shape (n,)                              [m/s or rad/s]
  /// @return          zero force for everything but LimiterStatus::limited; and after such a
  ///                  tick, force that grows from zero to full in ramp_s
  /// `strict` is passive if the velocity is the device's own, if the torque goes back through the
  /// transpose of the map the velocity came by, and if nobody scales it up afterwards.
  /// Real-time: O(n³), about 1 microsecond for 3 axes, 5 for 7; no allocation.
  LimiterOutput limit(const AxisMatrixView& drag, const AxisVectorView& velocity,
                      const LimiterTick& tick = {}) noexcept;

  /// For a tick that cannot be limited because its input is refused: the force is zero, and what
  /// follows grows from there.
  void drop() noexcept { ramp_ = 0; }

  /// As constructed.
  void restart() noexcept {
    ramp_ = 1;
    counts_ = {};
  }

 private:
  LimiterStatus judge(const AxisMatrixView& drag, const AxisVectorView& velocity,
                      const LimiterTick& tick) const noexcept;

  LimiterMode mode_;
  AxisKind axes_;
  AxisMatrix whiten_damping_, whiten_mass_;  // W B W' = I; the latter empty where M is unknown
  double damping_rounding_ = 0, mass_rounding_ = 0;  // of whitening, relative to its result
  double damping_factor_ = 0, mass_limit_ = 0;
  AxisVector encoder_step_, dry_friction_, torque_limits_;  // empty where unknown
  double force_limit_;
  double period_s_, ramp_s_;
  int longest_hold_;
  double ramp_ = 1;
  LimiterCounts counts_;
};

}  // namespace vicinity
