// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "field_in_use.h"

#include <utility>

#include "replay/felt_messages.h"

namespace vicinity::bridge {

FieldInUse::FieldInUse(const cli::Arm& arm)
    : arm_(arm), loop_(static_cast<int>(arm.robot.coordinates.size())) {}

void FieldInUse::offer(ViscosityField field) {
  waiting_ = std::move(field);
  hand_over();
}

void FieldInUse::hand_over() {
  if (!waiting_) return;
  const bool first = teleoperation_ == nullptr;
  if (!first && loop_.fields_taken() + 1 != given_.size()) return;
  // Gone from here whatever happens: one that fails is not tried for ever.
  const ViscosityField field = *std::exchange(waiting_, std::nullopt);
  if (first) {
    auto made = std::make_unique<Teleoperation>(arm_.robot, arm_.points, field, arm_.teleoperation);
    note(field);
    teleoperation_ = std::move(made);
    loop_.feel(*teleoperation_);
    return;
  }
  note(field);  // before the tick can answer from it
  try {
    teleoperation_->swap_field(field);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    given_.pop_back();
    throw;
  }
}

void FieldInUse::note(const ViscosityField& field) {
  const std::lock_guard lock(mutex_);
  if (given_.size() >= 2) given_[given_.size() - 2].field.reset();
  given_.push_back({.field = field, .objects = cli::object_names(field)});
}

std::vector<std::string> FieldInUse::objects(const Answer& answer) const {
  if (answer.sample.heard != Heard::state) return {};
  const std::lock_guard lock(mutex_);
  return given_.at(answer.output.counts.fields_taken).objects;
}

std::optional<ViscosityField> FieldInUse::field(const Answer& answer) const {
  if (answer.sample.heard != Heard::state) return {};
  const std::lock_guard lock(mutex_);
  return given_.at(answer.output.counts.fields_taken).field;
}

}  // namespace vicinity::bridge
