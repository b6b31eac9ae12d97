// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/mcap_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "commands/csv_cell.h"
#include "mcap/reader.h"
#include "replay/felt_messages.h"
#include "ros2/cdr.h"
#include "ros2/messages.h"
#include "ros2/topics.h"
#include "vicinity/geometry/error.h"

namespace vicinity::cli {
namespace {

using Names = std::vector<std::string>;

// One joint state, and by its time what else was recorded then.
struct JointLine {
  std::uint64_t stamp_ns = 0;
  std::uint64_t log_ns = 0;
  std::vector<double> position, velocity;
};

// What one topic has of joint states, by the joints they name.
using Senders = std::map<Names, std::vector<JointLine>>;

// What our own recordings hold beside them, by the time of the record.
struct Felt {
  Names joints;
  std::map<std::uint64_t, std::vector<double>> torque;
  std::map<std::uint64_t, ros2::Wrench> wrench;
  std::map<std::uint64_t, double> force, distance;
  std::map<std::uint64_t, ros2::DiagnosticStatus> status;
};

bool is_finite(double number) { return std::isfinite(number); }

class McapLog {
 public:
  explicit McapLog(const std::filesystem::path& path) : where_(path.string()) {
    ending_ = mcap::read(path, [this](const auto& schema, const auto& channel,
                                      const auto& message) { take(schema, channel, message); });
  }

  LogText text() const {
    const auto& [names, lines] = fullest(chosen_topic());
    LogText log{.csv = csv(names, sorted(lines))};
    if (!ending_.whole) {
      log.remarks.push_back(
          fmt::format("the recording was cut off ({}): its first {} of {} bytes are used",
                      ending_.why, ending_.used, ending_.file_size));
    }
    if (const std::size_t others = topics_.at(chosen_topic()).size() - 1; others > 0) {
      log.remarks.push_back(
          fmt::format("{} holds messages of {} senders: those that name {} joints are used",
                      chosen_topic(), others + 1, names.size()));
    }
    const auto nowhere = nowhere_.find(chosen_topic());
    if (nowhere != nowhere_.end()) {
      log.remarks.push_back(
          fmt::format("{} joint states on {} hold positions that are not finite: they are left out",
                      nowhere->second, nowhere->first));
    }
    return log;
  }

 private:
  void take(const mcap::Schema& schema, const mcap::Channel& channel,
            const mcap::Message& message) {
    if (channel.message_encoding != "cdr") return;
    if (schema.name == ros2::JointState::type) {
      take_joints(channel, message);
    } else if (channel.topic == ros2::topic::wrench && schema.name == ros2::WrenchStamped::type) {
      felt_.wrench[message.log_time_ns] = decoded<ros2::WrenchStamped>(channel, message).wrench;
    } else if (schema.name == ros2::Float64::type) {
      if (channel.topic == ros2::topic::master_force) {
        felt_.force[message.log_time_ns] = decoded<ros2::Float64>(channel, message).data;
      } else if (channel.topic == ros2::topic::reason_distance) {
        felt_.distance[message.log_time_ns] = decoded<ros2::Float64>(channel, message).data;
      }
    } else if (channel.topic == ros2::topic::diagnostics &&
               schema.name == ros2::DiagnosticArray::type) {
      for (ros2::DiagnosticStatus& status :
           decoded<ros2::DiagnosticArray>(channel, message).status) {
        if (status.name.starts_with("vicinity")) {
          felt_.status[message.log_time_ns] = std::move(status);
        }
      }
    }
  }

  void take_joints(const mcap::Channel& channel, const mcap::Message& message) {
    ros2::JointState state = decoded<ros2::JointState>(channel, message);
    if (channel.topic == ros2::topic::joint_efforts) {
      if (state.effort.size() != state.name.size()) return;
      felt_.joints = std::move(state.name);
      felt_.torque[message.log_time_ns] = std::move(state.effort);
      return;
    }
    if (state.position.size() != state.name.size() || state.name.empty()) return;
    if (!std::ranges::all_of(state.position, is_finite)) {
      ++nowhere_[channel.topic];
      return;
    }
    // NaN is what hardware says that measures none.
    if (state.velocity.size() != state.name.size() ||
        !std::ranges::all_of(state.velocity, is_finite)) {
      state.velocity.clear();
    }
    const ros2::Time& stamp = state.header.stamp;
    const bool stamped = stamp.sec >= 0 && nanoseconds_of(stamp) > 0;
    topics_[channel.topic][state.name].push_back(
        {.stamp_ns = stamped ? nanoseconds_of(stamp) : message.log_time_ns,
         .log_ns = message.log_time_ns,
         .position = std::move(state.position),
         .velocity = std::move(state.velocity)});
  }

  template <class Message>
  Message decoded(const mcap::Channel& channel, const mcap::Message& message) const {
    Message said;
    if (!ros2::read_cdr(message.data, said)) {
      throw Error({.where = where_,
                   .what = fmt::format("message {} on {} is no {}", message.sequence, channel.topic,
                                       Message::type)});
    }
    return said;
  }

  std::string chosen_topic() const {
    if (topics_.contains(std::string(ros2::topic::joint_states))) {
      return std::string(ros2::topic::joint_states);
    }
    if (topics_.size() == 1) return topics_.begin()->first;
    if (topics_.empty()) {
      throw Error({.where = where_,
                   .what = ending_.whole ? "the recording holds no joint states with positions"
                                         : "the recording was cut off before its first joint state",
                   .expected = "sensor_msgs/msg/JointState in CDR, as ROS 2 records them"});
    }
    Names names;
    for (const auto& [topic, senders] : topics_) names.push_back(topic);
    throw Error({.where = where_,
                 .what = "several topics hold joint states, and none is /joint_states",
                 .found = fmt::format("{}", fmt::join(names, ", ")),
                 .hint = "a recording of one of them"});
  }

  const Senders::value_type& fullest(const std::string& topic) const {
    return *std::ranges::max_element(topics_.at(topic), {},
                                     [](const auto& sender) { return sender.first.size(); });
  }

  static std::vector<const JointLine*> sorted(const std::vector<JointLine>& lines) {
    std::vector<const JointLine*> order;
    for (const JointLine& line : lines) order.push_back(&line);
    std::ranges::stable_sort(order, {}, &JointLine::stamp_ns);
    const auto same = std::ranges::unique(order, {}, &JointLine::stamp_ns);
    order.erase(same.begin(), same.end());
    return order;
  }

  std::string csv(const Names& names, const std::vector<const JointLine*>& lines) const {
    const bool velocities =
        std::ranges::none_of(lines, [](const JointLine* line) { return line->velocity.empty(); });
    const bool felt = !felt_.torque.empty() || !felt_.status.empty();
    std::string text = "t";
    const auto add_names = [&](std::string_view prefix, const Names& joints) {
      for (const std::string& name : joints) text += "," + csv_cell(std::string(prefix) + name);
    };
    add_names("", names);
    if (velocities) add_names("qd_", names);
    if (felt) {
      add_names("tau_", felt_.joints);
      text +=
          ",tool_fx,tool_fy,tool_fz,tool_mx,tool_my,tool_mz,master_force,status,reason_link,"
          "reason_object,reason_rank,reason_distance_mm";
    }
    text += '\n';
    for (const JointLine* line : lines) {
      const auto out = std::back_inserter(text);
      fmt::format_to(out, "{}.{:09}", line->stamp_ns / 1'000'000'000,
                     line->stamp_ns % 1'000'000'000);
      for (const double q : line->position) fmt::format_to(out, ",{}", q);
      if (velocities) {
        for (const double qd : line->velocity) fmt::format_to(out, ",{}", qd);
      }
      if (felt) add_felt(text, line->log_ns);
      text += '\n';
    }
    return text;
  }

  void add_felt(std::string& text, std::uint64_t time_ns) const {
    const auto out = std::back_inserter(text);
    const auto cell = [&](const auto& from) {
      const auto found = from.find(time_ns);
      text += ',';
      if (found != from.end()) fmt::format_to(out, "{}", found->second);
    };
    const auto torque = felt_.torque.find(time_ns);
    for (std::size_t n = 0; n < felt_.joints.size(); ++n) {
      text += ',';
      if (torque != felt_.torque.end() && n < torque->second.size()) {
        fmt::format_to(out, "{}", torque->second[n]);
      }
    }
    const auto wrench = felt_.wrench.find(time_ns);
    if (wrench == felt_.wrench.end()) {
      text += ",,,,,,";
    } else {
      const auto& [f, m] = wrench->second;
      fmt::format_to(out, ",{},{},{},{},{},{}", f.x, f.y, f.z, m.x, m.y, m.z);
    }
    cell(felt_.force);
    add_reason(text, time_ns);
    text += ',';
    if (const auto found = felt_.distance.find(time_ns); found != felt_.distance.end()) {
      fmt::format_to(out, "{:.6g}", 1000 * found->second);
    }
  }

  // A status stands until the next.
  void add_reason(std::string& text, std::uint64_t time_ns) const {
    const auto next = felt_.status.upper_bound(time_ns);
    if (next == felt_.status.begin()) {
      text += ",,,,";
      return;
    }
    const ros2::DiagnosticStatus& status = std::prev(next)->second;
    (text += ',') += csv_cell(status.message);
    for (const std::string_view key : {"link", "object", "rank"}) {
      const auto value = std::ranges::find(status.values, key, &ros2::KeyValue::key);
      text += ',';
      if (value != status.values.end()) text += csv_cell(value->value);
    }
  }

  std::string where_;
  mcap::Ending ending_;
  std::map<std::string, Senders> topics_;
  std::map<std::string, std::size_t> nowhere_;  // by topic: states without a position
  Felt felt_;
};

}  // namespace

LogText mcap_as_csv(const std::filesystem::path& path) { return McapLog(path).text(); }

}  // namespace vicinity::cli
