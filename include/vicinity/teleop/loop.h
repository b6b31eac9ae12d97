// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The loop of figures 1 and 31 to 33: master, aid, the way between, slave, and what comes back.
///
///        hand                                                          workplace
///          |  x_m, quantised                                               ^
///   +------v------+   q led     +-----------+   q led, later   +-----------+---+
///   |   master    +------+------> transport +------------------>  slave servo  |
///   |             |  [aid, local]           |  [aid, remote]   |               |
///   |             <------+------+ transport <------------------+               |
///   +-------------+   force     +-----------+   tau2, force    +---------------+
///
/// No physics in here: who owns the master, the slave and the clock calls master() and slave().
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "vicinity/teleop/aid.h"
#include "vicinity/teleop/axes.h"
#include "vicinity/teleop/energy_audit.h"
#include "vicinity/teleop/lead.h"
#include "vicinity/teleop/master_force.h"
#include "vicinity/teleop/transport.h"

namespace vicinity {

/// Where the aid is computed.
enum class Placement : std::uint8_t {
  local,   ///< beside the master, from what it leads to: no delay between motion and force
  remote,  ///< beside the slave, from what arrives there: the force comes back a round trip late
};

const char* to_string(Placement placement) noexcept;

struct LoopOptions {
  double period_s = 0.001;       ///< T of the master                                  [s]
  int slave_periods = 1;         ///< the slave's controller runs every so many of them, >= 1
  TransportOptions there, back;  ///< to the slave, and from it
  Placement placement = Placement::local;
  MasterArm master;              ///< G, A, L and lambda of eq. 10
  double reflected_limit = 0;    ///< on the norm of the reflected force; zero: none [N or N·m]
  Eigen::VectorXd encoder_step;  ///< of the master's axes, one value each; empty: exact
  Eigen::MatrixXd damping;       ///< of the device itself, for the audit; empty: zero
};

/// What acts on the master until the next period, shape (n,) each [N or N·m].
struct MasterTick {
  AxisVector aid;        ///< lambda G/L times the aid's force
  AxisVector reflected;  ///< lambda/(A L) times the slave's own torque, against the hand
};

/// One master and one slave. Real-time but for the constructor: nothing after it allocates.
class TeleoperationLoop {
 public:
  /// @param aid   outlives the loop
  /// Errors: throws Error for options that do not fit together, and as Lead and Transport.
  TeleoperationLoop(Lead lead, Aid& aid, const LoopOptions& options);

  /// Both arms stand still at q and x, and nothing is under way.
  void start(const AxisVector& q, const AxisVector& x, std::uint64_t seed) noexcept;

  /// One period of the master.
  /// @param time_s  one more period than the last time
  /// @param x       the device's true position, shape (n,) [rad or m]
  const MasterTick& master(double time_s, const AxisVector& x) noexcept;

  /// One period of the slave's controller: where its joints should be now.
  /// @param tau2  its own torque: inertia, friction, contact, shape (joints,) [N·m or N]
  const AxisVector& slave(double time_s, const AxisVector& tau2) noexcept;

  const Lead& lead() const noexcept { return lead_; }
  /// The aid's account at the master, on true positions, with the device's own damping.
  const EnergyBalance& energy() const noexcept { return audit_.balance(); }
  /// Of the last aid, wherever it was computed.
  double speed_scale() const noexcept { return speed_scale_; }

 private:
  struct Leading {
    double time_s = 0;  // when the master stood there: velocities come of that, not of arrivals
    AxisVector q;
  };
  struct Answer {
    AxisVector torque, aid;
    bool felt = false;
  };

  Input input(double time_s, const AxisVector& q) const noexcept;

  Lead lead_;
  Aid& aid_;
  LoopOptions options_;
  Transport<Leading> there_;
  Transport<Answer> back_;
  EnergyAudit audit_;
  AxisVector command_, torque_, aid_force_;
  MasterTick tick_;
  double speed_scale_ = 1;
  int aid_age_ = 0;
};

}  // namespace vicinity
