// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What helps the operator: told where the arm is led, it answers with a force on the master.
#pragma once

#include "vicinity/teleop/axes.h"
#include "vicinity/teleop/tick.h"

namespace vicinity {

struct AidForce {
  AxisVector force;        ///< on the master's axes, shape (n,) [N or N·m]
  double speed_scale = 1;  ///< of the led motion, 0..1: what the slave is asked of what is led
};

/// One for each arm. Real-time, all of it: no allocation, lock or exception.
class Aid {
 public:
  virtual ~Aid() = default;
  /// One period. @param input  the joints that the master leads to, as the tick takes them
  virtual AidForce feel(const Input& input) noexcept = 0;
  /// The next feel() is the first one.
  virtual void restart() noexcept = 0;
};

/// The drag: tick(), as it runs on hardware.
class DragAid final : public Aid {
 public:
  explicit DragAid(Teleoperation& teleoperation) : teleoperation_(teleoperation) {}

  AidForce feel(const Input& input) noexcept override {
    (void)teleoperation_.tick(input, output_);  // the output holds its status, and a safe force
    return {output_.device_force, 1};
  }
  void restart() noexcept override { teleoperation_.restart(); }

  /// Of the last tick.
  const Output& output() const noexcept { return output_; }

 private:
  Teleoperation& teleoperation_;
  Output output_;
};

}  // namespace vicinity
