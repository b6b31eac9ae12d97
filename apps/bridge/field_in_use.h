// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The arm's loop, and the fields that it feels one after the other.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "arm_loop.h"
#include "replay/arm.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::bridge {

/// Everything that is made for a field is made, and freed, outside the tick's thread.
class FieldInUse {
 public:
  /// Starts the loop. @param arm  outlives it
  explicit FieldInUse(const cli::Arm& arm);

  ArmLoop& loop() noexcept { return loop_; }

  /// The field that is to be felt from now on. For one thread, the same as hand_over().
  /// Errors: as hand_over().
  void offer(ViscosityField field);
  /// Hands the newest to the tick, once it has taken the one before: so that every answer can say
  /// which field it is about. To be called now and then.
  /// Errors: throws what Teleoperation throws; the field before it is felt on, and this one is no
  /// more.
  void hand_over();

  /// Of the field that a state was answered from; empty where there was none. From any thread.
  std::vector<std::string> objects(const Answer& answer) const;
  /// The same field, where it is not long ago.
  std::optional<ViscosityField> field(const Answer& answer) const;

 private:
  struct Given {
    std::optional<ViscosityField> field;  // of the last two
    std::vector<std::string> objects;
  };
  void note(const ViscosityField& field);

  const cli::Arm& arm_;
  std::optional<ViscosityField> waiting_;
  mutable std::mutex mutex_;
  std::vector<Given> given_;  // the n-th bears the number n, as Counts::fields_taken
  std::unique_ptr<Teleoperation> teleoperation_;
  ArmLoop loop_;  // ends before what it ticks
};

/// Notices that an answer is about another field than those before it.
class FieldNumber {
 public:
  bool is_new(const Answer& answer) noexcept {
    if (answer.sample.heard != Heard::state || answer.output.counts.fields_taken == number_) {
      return false;
    }
    number_ = answer.output.counts.fields_taken;
    return true;
  }

 private:
  std::optional<std::uint64_t> number_;
};

}  // namespace vicinity::bridge
