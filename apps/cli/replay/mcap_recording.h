// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A recording as an MCAP file of ROS 2 messages, which Foxglove and PlotJuggler show.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mcap/writer.h"
#include "replay/felt_messages.h"
#include "replay/recording.h"

namespace vicinity::cli {

/// Writes ticks, one after the other: for each the joint states it was given, joint efforts, the
/// wrench at the tool, the master's force and, where it is known, the distance of the point that
/// contributed most; and diagnostics whenever status, link, object or rank are others than before.
class McapRecording {
 public:
  /// @param sink  as mcap::Writer
  /// @param objects  names of the field's objects
  McapRecording(mcap::Sink sink, const RobotModel& robot, std::vector<std::string> objects,
                int tool_link);

  /// @param time_ns        as stamp_of()
  /// @param q,torque       shape (joints,) [rad or m], [N·m or N]
  /// @param status,level   as FeltMessages::diagnostics()
  void add(std::uint64_t time_ns, std::span<const double> q, std::span<const double> torque,
           const Wrench& tool_W, double master_force, const Reason& reason, const Pose& X_WB,
           std::string_view status, std::byte level);

  /// Of a state that is no place: its diagnostics alone, where they are others than before.
  void say(std::uint64_t time_ns, const Reason& reason, std::string_view status, std::byte level);

  /// Another field from now on.
  void name_objects(std::vector<std::string> objects) {
    messages_.name_objects(std::move(objects));
    said_.clear();
  }

  mcap::Writer& file() noexcept { return file_; }

 private:
  template <class Message>
  std::uint16_t channel(std::string_view topic);
  template <class Message>
  void put(std::uint16_t channel, std::uint64_t time_ns, const Message& message);

  mcap::Writer file_;
  FeltMessages messages_;
  std::vector<std::pair<std::string_view, std::uint16_t>> schemas_;  // type, its number
  std::uint16_t states_, efforts_, wrench_, force_, distance_, diagnostics_;
  std::vector<std::byte> bytes_;
  // Of the last diagnostics.
  std::string said_;
  Reason said_reason_;
};

/// Times that a message can be stamped with [s]. Errors: throws Error, naming `where`, for others.
void check_times(double first_s, double last_s, const std::string& where);

/// A time in seconds as nanoseconds.
std::uint64_t nanoseconds(double time_s);

}  // namespace vicinity::cli
