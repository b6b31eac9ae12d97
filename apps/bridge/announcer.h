// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What goes out for every answer: wrench, efforts, speed scale, and diagnostics where they change.
#pragma once

#include <map>
#include <string>

#include "arm_loop.h"
#include "dds/participant.h"
#include "field_in_use.h"
#include "replay/felt_messages.h"

namespace vicinity::bridge {

/// Of a tool that drag b [N·s/m] holds back: half / (half + b), so that a drag of `half` halves its
/// speed, and one that is felt twice as much slows it that much more.
double speed_scale(double drag, double half) noexcept;

/// In words: that of the tick where a state was heard, else why there is none.
const char* status_of(const Answer& answer) noexcept;
std::byte level_of(const Answer& answer) noexcept;

/// For one thread. Not real-time.
class Announcer {
 public:
  /// @param half_speed_drag  as speed_scale() [N·s/m], > 0
  Announcer(dds::Participant& participant, const FieldInUse& field, const RobotModel& robot,
            int tool_link, double half_speed_drag);

  void announce(const Answer& answer);

  /// Answers so far, by status.
  const std::map<std::string, std::uint64_t>& statuses() const noexcept { return statuses_; }
  /// The last that was said.
  double scale() const noexcept { return scale_; }
  /// Messages that DDS did not take.
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  template <class Message>
  void put(dds_entity_t writer, const Message& message) {
    if (!dds::send(writer, message, bytes_)) ++refused_;
  }
  void find_scale(const Answer& answer);

  const FieldInUse& field_;
  FieldNumber named_;
  cli::FeltMessages messages_;
  ForwardKinematics kinematics_;
  double half_speed_drag_;
  dds_entity_t wrench_, efforts_, force_, scale_topic_, diagnostics_;
  dds::Sample bytes_;
  AxisVector last_q_;
  double last_time_s_ = 0, scale_ = 0;
  std::int64_t felt_ns_ = 0;  // the last answer that was felt
  // Of the last diagnostics.
  std::string said_;
  Reason said_reason_;
  std::int64_t said_ns_ = 0;
  std::map<std::string, std::uint64_t> statuses_;
  std::uint64_t refused_ = 0;
};

}  // namespace vicinity::bridge
