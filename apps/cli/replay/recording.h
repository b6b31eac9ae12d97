// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What came out of every tick, in memory that is taken before the first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vicinity/teleop/tick.h"

namespace vicinity::cli {

/// One tick.
struct TickRecord {
  double time_s = 0;        ///< since the first tick [s]
  Wrench tool;              ///< all drag about the tool link's origin, in W [N], [N·m]
  double master_force = 0;  ///< [N]
  Reason reason;            ///< the point that contributed most
  double scale = 1;         ///< of the limiter; 1 where there is none
  std::uint32_t points_felt = 0;
  float tick_us = 0;  ///< how long the tick took [µs]
  float late_us = 0;  ///< how late it began, in real time [µs]
  Status status = Status::ok;
  DragLimit limit = DragLimit::none;
};

/// Adding takes no memory, makes no system call and waits for nobody.
class Recording {
 public:
  /// All memory is written to once, so that no tick is the first to touch a page of it.
  Recording(std::size_t capacity, std::size_t joints);

  /// @param q                that the tick was given, shape (joints(),) [rad or m]
  /// @param late_us,tick_us  as in TickRecord. Does nothing once it is full.
  void add(double time_s, const double* q, const Output& output, double late_us,
           double tick_us) noexcept;

  std::span<const TickRecord> ticks() const noexcept { return {ticks_.data(), size_}; }
  std::size_t joints() const noexcept { return joints_; }
  /// Joint torques of a tick, shape (joints(),) [N·m or N].
  std::span<const double> torque(std::size_t tick) const noexcept {
    return {&torques_[tick * joints_], joints_};
  }
  /// Joint positions of a tick, shape (joints(),) [rad or m].
  std::span<const double> position(std::size_t tick) const noexcept {
    return {&positions_[tick * joints_], joints_};
  }
  /// The energy account as the last tick left it.
  const EnergyBalance& energy() const noexcept { return energy_; }

 private:
  std::vector<TickRecord> ticks_;
  std::vector<double> torques_, positions_;
  std::size_t joints_, size_ = 0;
  EnergyBalance energy_;
};

}  // namespace vicinity::cli
