// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/mcap_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ros2/cdr.h"
#include "ros2/schema.h"
#include "ros2/topics.h"
#include "vicinity/geometry/error.h"

namespace vicinity::cli {

McapRecording::McapRecording(mcap::Sink sink, const RobotModel& robot,
                             std::vector<std::string> objects, int tool_link)
    : file_(std::move(sink), "ros2", "vicinity"),
      messages_(robot, tool_link),
      states_(channel<ros2::JointState>(ros2::topic::joint_states)),
      efforts_(channel<ros2::JointState>(ros2::topic::joint_efforts)),
      wrench_(channel<ros2::WrenchStamped>(ros2::topic::wrench)),
      force_(channel<ros2::Float64>(ros2::topic::master_force)),
      distance_(channel<ros2::Float64>(ros2::topic::reason_distance)),
      diagnostics_(channel<ros2::DiagnosticArray>(ros2::topic::diagnostics)) {
  messages_.name_objects(std::move(objects));
}

void McapRecording::add(std::uint64_t time_ns, std::span<const double> q,
                        std::span<const double> torque, const Wrench& tool_W, double master_force,
                        const Reason& reason, const Pose& X_WB, std::string_view status,
                        std::byte level) {
  const ros2::Time stamp = stamp_of(time_ns);
  put(states_, time_ns, messages_.joint_states(stamp, q));
  put(efforts_, time_ns, messages_.joint_efforts(stamp, torque));
  put(wrench_, time_ns, messages_.wrench(stamp, tool_W, q, X_WB));
  put(force_, time_ns, ros2::Float64{master_force});
  const bool known = reason.link >= 0 && reason.object >= 0;
  if (known) put(distance_, time_ns, ros2::Float64{reason.distance_m});
  say(time_ns, reason, status, level);
}

void McapRecording::say(std::uint64_t time_ns, const Reason& reason, std::string_view status,
                        std::byte level) {
  const bool unchanged = said_ == status && said_reason_.link == reason.link &&
                         said_reason_.object == reason.object && said_reason_.rank == reason.rank;
  if (unchanged) return;
  put(diagnostics_, time_ns, messages_.diagnostics(stamp_of(time_ns), status, level, reason));
  said_ = status;
  said_reason_ = reason;
}

template <class Message>
std::uint16_t McapRecording::channel(std::string_view topic) {
  auto schema = std::ranges::find(schemas_, Message::type, &decltype(schemas_)::value_type::first);
  if (schema == schemas_.end()) {
    const std::uint16_t number = file_.add_schema(
        Message::type, "ros2msg", ros2::schema_text(ros2::Describer::of<Message>()));
    schema = schemas_.insert(schemas_.end(), {Message::type, number});
  }
  return file_.add_channel(topic, schema->second, "cdr");
}

template <class Message>
void McapRecording::put(std::uint16_t channel, std::uint64_t time_ns, const Message& message) {
  ros2::write_cdr(message, bytes_);
  file_.write(channel, time_ns, bytes_);
}

void check_times(double first_s, double last_s, const std::string& where) {
  constexpr double end_s = 2147483648.0;  // a stamp's seconds are 32 bits with a sign
  if (first_s >= 0 && last_s < end_s) return;
  throw Error({.where = where,
               .what = "times of this log cannot be those of an MCAP recording",
               .found = fmt::format("{} to {} s", first_s, last_s),
               .expected = fmt::format("0 to {:.0f} s", end_s),
               .hint = "a factor for t in --columns, or a .csv recording"});
}

std::uint64_t nanoseconds(double time_s) {
  return static_cast<std::uint64_t>(std::llround(1e9 * time_s));
}

}  // namespace vicinity::cli
