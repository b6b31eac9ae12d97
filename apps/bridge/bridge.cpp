// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "bridge.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <syncstream>
#include <thread>
#include <utility>

#include "announcer.h"
#include "field_follower.h"
#include "field_in_use.h"
#include "field_sharer.h"
#include "interruption.h"
#include "progress_bar.h"
#include "recorder.h"
#include "replay/felt_messages.h"
#include "replay/real_time.h"
#include "ros2/topics.h"
#include "surroundings.h"
#include "vicinity/geometry/error.h"
#include "watched_input.h"

namespace vicinity::bridge {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t last_domain = 232;  // beyond, there are no ports
constexpr double wait_s = 0.05;             // before looking whether to end

ViscosityField first_field(WatchedInput& input, std::ostream& err) {
  cli::ProgressBar bar(err);
  BuildOptions build;
  build.progress = [&](std::string_view stage, double done) { bar.show(stage, done); };
  return input.field(build);
}

void check_name(const char* option, const std::string& name) {
  if (name.empty()) return;
  const std::string allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_/";
  if (name.front() != '/') {
    throw Error(
        {.where = option, .what = "a name begins with a slash", .found = name, .hint = "/" + name});
  }
  if (name.size() < 2 || name.find_first_not_of(allowed) != std::string::npos ||
      name.find("//") != std::string::npos || name.back() == '/') {
    throw Error({.where = option,
                 .what = "is no name of ROS 2",
                 .found = name,
                 .expected = "letters, digits and '_', as in /left"});
  }
}

dds::ParticipantOptions participant_options(const BridgeOptions& options) {
  if (options.domain > last_domain) {
    throw Error({.where = "--domain",
                 .what = "there is no such domain",
                 .found = std::to_string(options.domain),
                 .expected = fmt::format("0 to {}", last_domain)});
  }
  check_name("--namespace", options.name_space);
  check_name("--share-field", options.share_field);
  check_name("--follow-field", options.follow_field);
  if (!options.follow_field.empty() && is_scene(options.input)) {
    throw Error({.where = options.input.string(),
                 .what = "is a scene, and no place for the copy of a field",
                 .hint = "a name that ends in .vicinity; it need not be there yet"});
  }
  if (!(options.half_speed_drag > 0 && std::isfinite(options.half_speed_drag))) {
    throw Error({.where = "--half-speed-drag",
                 .what = "is no drag that slows anything",
                 .found = fmt::format("{:g}", options.half_speed_drag),
                 .expected = "N·s/m, more than zero"});
  }
  if (options.seconds && !(*options.seconds > 0 && std::isfinite(*options.seconds))) {
    throw Error({.where = "--seconds",
                 .what = "is no time to end after",
                 .found = fmt::format("{:g}", *options.seconds),
                 .expected = "seconds, more than zero"});
  }
  if (!options.recording.empty() && options.recording.extension() != ".mcap") {
    throw Error({.where = options.recording.string(),
                 .what = "a recording of the bridge is MCAP, whatever it is called",
                 .hint = "a name that ends in .mcap"});
  }
  std::string configuration;
  if (!options.dds.empty()) {
    if (!std::filesystem::exists(options.dds)) {
      throw Error({.where = options.dds.string(), .what = "there is no such file"});
    }
    configuration = "file://" + std::filesystem::absolute(options.dds).string();
  }
  return {
      .domain = options.domain, .configuration = configuration, .name_space = options.name_space};
}

// What came in.
struct Received {
  std::uint64_t joint_states = 0, of_others = 0, transforms = 0, bad_transforms = 0, no_room = 0;
};

std::int64_t since_1970_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

struct Readers {
  explicit Readers(dds::Participant& participant)
      // A state that has to be sent again comes too late: the next is better. Those that come
      // while this machine is busy elsewhere are kept, a tenth of a second of them.
      : states(participant.reader<ros2::JointState>(ros2::topic::joint_states,
                                                    {.reliable = false, .depth = 100})),
        tf(participant.reader<ros2::TFMessage>(ros2::topic::tf, {.named_alone = true})),
        tf_static(participant.reader<ros2::TFMessage>(
            ros2::topic::tf_static, {.depth = 100, .latched = true, .named_alone = true})),
        waiter(participant, {states, tf, tf_static}) {}

  dds_entity_t states, tf, tf_static;
  dds::Participant::Waiter waiter;
};

// One thread: DDS in, judged, to the loop.
Received receive(const Readers& readers, Intake& intake, ArmLoop& loop, const std::string& world,
                 const std::stop_token& stop) {
  Received received;
  dds::Sample bytes;
  while (!stop.stop_requested()) {
    readers.waiter.wait(wait_s);
    for (const dds_entity_t reader : {readers.tf, readers.tf_static}) {
      while (dds::take(reader, bytes)) {
        ++received.transforms;
        if (!intake.transforms(bytes, world)) ++received.bad_transforms;
      }
    }
    while (dds::take(readers.states, bytes)) {
      ++received.joint_states;
      const auto sample = intake.joint_state(
          bytes, {.since_1970_ns = since_1970_ns(), .monotonic_ns = cli::monotonic_ns()});
      if (!sample) {
        ++received.of_others;
      } else if (!loop.give(*sample)) {
        ++received.no_room;
      }
    }
  }
  return received;
}

// The newest answer, for whoever draws. Neither side of it is the tick.
class Newest {
 public:
  void put(const Answer& answer) {
    const std::lock_guard lock(mutex_);
    answer_ = answer;
  }
  Answer get() const {
    const std::lock_guard lock(mutex_);
    return answer_;
  }

 private:
  mutable std::mutex mutex_;
  Answer answer_;
};

// One thread: pictures, at their own pace.
void draw(dds_entity_t markers, dds_entity_t layers, Surroundings& surroundings,
          const FieldInUse& in_use, const Newest& newest, const std::stop_token& stop) {
  constexpr std::chrono::milliseconds period{100};
  constexpr int layers_every = 5;
  dds::Sample bytes;
  FieldNumber drawn;
  for (int n = 0; !stop.stop_requested(); ++n) {
    const Answer answer = newest.get();
    if (drawn.is_new(answer)) {
      if (auto field = in_use.field(answer)) surroundings.look_at(std::move(*field));
    }
    if (dds::is_heard(markers)) (void)dds::send(markers, surroundings.markers(answer), bytes);
    // Every voxel around the arm is looked at for them.
    if (n % layers_every == 0 && dds::is_heard(layers)) {
      (void)dds::send(layers, surroundings.layers(answer), bytes);
    }
    std::this_thread::sleep_for(period);
  }
}

// One thread: the field as it changes, shared or followed.
template <class Source>
void tend(Source& source, FieldInUse& in_use, dds_entity_t diagnostics, const Say& say,
          const std::stop_token& stop) {
  constexpr std::chrono::seconds say_again{1};
  dds::Sample bytes;
  ros2::DiagnosticArray message;
  message.status.emplace_back().name = "vicinity: field";
  FieldStanding said;
  Clock::time_point said_at;
  bool works = true;
  while (!stop.stop_requested()) {
    try {
      if (works) {
        if (auto field = source.step(wait_s)) in_use.offer(std::move(*field));
      } else {
        std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
      }
      in_use.hand_over();
    } catch (const std::exception& error) {
      say(std::string(error.what()) + "; the field stays as it is from now on");
      works = false;
    }
    const FieldStanding standing =
        works ? source.standing()
              : FieldStanding{ros2::DiagnosticStatus::error, "it stays as it is: see the output"};
    if (standing == said && Clock::now() - said_at < say_again) continue;
    message.header.stamp = cli::stamp_of(static_cast<std::uint64_t>(since_1970_ns()));
    message.status.front().level = standing.level;
    message.status.front().message = standing.words;
    message.status.front().values = {{"checksum", hex(source.checksum())}};
    (void)dds::send(diagnostics, message, bytes);
    said = standing;
    said_at = Clock::now();
  }
}

template <class Source>
nlohmann::ordered_json summary_of_field(const Source& source) {
  const FieldTraffic& traffic = source.traffic();
  return {{"checksum", hex(source.checksum())}, {"fields", traffic.fields},
          {"chunks", traffic.chunks},           {"bytes", traffic.bytes},
          {"asked_again", traffic.asked_again}, {"refused", traffic.refused}};
}

nlohmann::ordered_json summary(const Received& received, const Announcer& announcer,
                               const Answer& last) {
  nlohmann::ordered_json json{{"joint_states", received.joint_states},
                              {"of_others", received.of_others},
                              {"transforms", received.transforms},
                              {"bad_transforms", received.bad_transforms},
                              {"no_room", received.no_room}};
  json["statuses"] = announcer.statuses();
  json["not_sent"] = announcer.refused();
  json["energy"] = {{"drag", last.output.energy.drag}, {"passive", last.output.energy.passive}};
  return json;
}

std::string in_words(const nlohmann::ordered_json& json) {
  std::string statuses;
  for (const auto& [status, count] : json["statuses"].items()) {
    statuses +=
        fmt::format("{}{} {}", statuses.empty() ? "" : ", ", count.get<std::uint64_t>(), status);
  }
  return fmt::format("heard     {} joint states and {} transforms\nanswered  {}\n",
                     json["joint_states"].get<std::uint64_t>(),
                     json["transforms"].get<std::uint64_t>(),
                     statuses.empty() ? "nothing" : statuses);
}

}  // namespace

int bridge(const BridgeOptions& options, std::ostream& out, std::ostream& err) {
  const dds::ParticipantOptions where = participant_options(options);
  const bool follows = !options.follow_field.empty();
  WatchedInput input(options.input);
  std::optional<ViscosityField> field;
  if (!follows) field = first_field(input, err);
  cli::ArmOptions arm_options = options.arm;
  if (arm_options.scene.empty() && arm_options.robot.empty() && is_scene(options.input)) {
    arm_options.scene = options.input;
  }
  const cli::Arm arm = cli::read_arm(arm_options);
  for (const std::string& remark : arm.remarks) err << "note: " << remark << '\n';
  const int tool = arm.teleoperation.tool_link;
  const cli::UntilAsked to_the_end;  // a signal is how it ends
  const Say say = [&](const std::string& sentence) {
    std::osyncstream(err) << sentence << '\n' << std::flush;
  };

  dds::Participant participant(where);
  std::optional<FieldSharer> sharer;
  std::optional<FieldFollower> follower;
  if (follows) {
    follower.emplace(participant, options.follow_field, options.input, say);
    field = follower->open_copy();
  } else if (!options.share_field.empty()) {
    sharer.emplace(participant, options.share_field, input, *field, say);
  }
  const auto in_use = std::make_unique<FieldInUse>(arm);
  if (field) in_use->offer(std::move(*field));
  ArmLoop& loop = in_use->loop();
  Intake intake(arm.robot, arm.X_WB);
  Announcer announcer(participant, *in_use, arm.robot, tool, options.half_speed_drag);
  Surroundings surroundings(arm.robot, arm.points, tool, options.world);
  std::unique_ptr<Recorder> recorder;
  if (!options.recording.empty()) {
    if (const auto kept = keep_earlier(options.recording); !kept.empty()) {
      err << "note: the earlier " << options.recording.string() << " is now " << kept.string()
          << '\n';
    }
    recorder = std::make_unique<Recorder>(options.recording, *in_use, arm.robot, tool);
  }
  const Readers readers(participant);
  const dds_entity_t markers = participant.writer<ros2::MarkerArray>(ros2::topic::markers);
  const dds_entity_t layers =
      participant.writer<ros2::PointCloud2>(ros2::topic::layers, {.depth = 1});
  const dds_entity_t diagnostics =
      participant.writer<ros2::DiagnosticArray>(ros2::topic::diagnostics);
  Newest newest;
  Received received;
  Answer answer;
  {
    std::jthread receiving([&](const std::stop_token& stop) {
      received = receive(readers, intake, loop, options.world, stop);
    });
    std::jthread drawing([&](const std::stop_token& stop) {
      draw(markers, layers, surroundings, *in_use, newest, stop);
    });
    std::jthread tending([&](const std::stop_token& stop) {
      if (sharer) tend(*sharer, *in_use, diagnostics, say, stop);
      if (follower) tend(*follower, *in_use, diagnostics, say, stop);
    });
    say(fmt::format("bridging {} joints of {} in domain {}{}", arm.robot.coordinates.size(),
                    arm.robot.name, options.domain,
                    options.dds.empty() ? ", on this machine alone" : ""));
    const Clock::time_point begin = Clock::now();
    const auto over = [&] {
      return options.seconds &&
             std::chrono::duration<double>(Clock::now() - begin).count() > *options.seconds;
    };
    while (!cli::interruption_asked() && !over()) {
      if (!loop.take(answer, static_cast<std::int64_t>(1e9 * wait_s))) continue;
      announcer.announce(answer);
      newest.put(answer);
      if (recorder != nullptr) recorder->add(answer);
    }
  }
  if (recorder != nullptr && !recorder->failure().empty()) {
    err << "note: " << recorder->failure() << '\n';
  }
  recorder.reset();
  nlohmann::ordered_json json = summary(received, announcer, answer);
  if (sharer) json["field"] = summary_of_field(*sharer);
  if (follower) json["field"] = summary_of_field(*follower);
  out << (options.json ? json.dump(2) + '\n' : in_words(json));
  out.flush();
  return 0;
}

}  // namespace vicinity::bridge
