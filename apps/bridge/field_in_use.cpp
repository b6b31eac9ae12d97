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
  if (teleoperation_ == nullptr) {
    note(*waiting_);
    teleoperation_ =
        std::make_unique<Teleoperation>(arm_.robot, arm_.points, *waiting_, arm_.teleoperation);
    loop_.feel(*teleoperation_);
  } else {
    if (loop_.fields_taken() + 1 != given_.size()) return;
    note(*waiting_);
    teleoperation_->swap_field(*waiting_);
  }
  waiting_.reset();
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
