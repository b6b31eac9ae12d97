// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "bridge.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "announcer.h"
#include "interruption.h"
#include "progress_bar.h"
#include "recorder.h"
#include "ros2/topics.h"
#include "surroundings.h"
#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::bridge {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t last_domain = 232;  // beyond, there are no ports
constexpr double wait_s = 0.05;             // before looking whether to end

ViscosityField open_input(const BridgeOptions& options, std::ostream& err) {
  const auto ending = options.input.extension();
  if (ending != ".yaml" && ending != ".yml") return open_field(options.input);
  cli::ProgressBar bar(err);
  BuildOptions build;
  build.progress = [&](std::string_view stage, double done) { bar.show(stage, done); };
  return build_field(read_scene(options.input), build).field;
}

dds::ParticipantOptions participant_options(const BridgeOptions& options) {
  if (options.domain > last_domain) {
    throw Error({.where = "--domain",
                 .what = "there is no such domain",
                 .found = std::to_string(options.domain),
                 .expected = fmt::format("0 to {}", last_domain)});
  }
  if (!options.name_space.empty() && options.name_space.front() != '/') {
    throw Error({.where = "--namespace",
                 .what = "a namespace begins with a slash",
                 .found = options.name_space,
                 .hint = "/" + options.name_space});
  }
  if (!(options.half_speed_drag > 0)) {
    throw Error({.where = "--half-speed-drag",
                 .what = "is no drag that slows anything",
                 .found = fmt::format("{:g}", options.half_speed_drag),
                 .expected = "N·s/m, more than zero"});
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
  std::uint64_t joint_states = 0, transforms = 0, bad_transforms = 0, no_room = 0;
};

std::int64_t since_1970_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

struct Readers {
  explicit Readers(dds::Participant& participant)
      : states(participant.reader<ros2::JointState>(ros2::topic::joint_states)),
        tf(participant.reader<ros2::TFMessage>(ros2::topic::tf)),
        tf_static(participant.reader<ros2::TFMessage>(ros2::topic::tf_static,
                                                      {.depth = 100, .latched = true})),
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
      if (!loop.give(intake.joint_state(bytes, since_1970_ns()))) ++received.no_room;
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
          const Newest& newest, const std::stop_token& stop) {
  constexpr std::chrono::milliseconds period{100};
  constexpr int layers_every = 5;
  dds::Sample bytes;
  for (int n = 0; !stop.stop_requested(); ++n) {
    const Answer answer = newest.get();
    (void)dds::send(markers, surroundings.markers(answer), bytes);
    if (n % layers_every == 0) (void)dds::send(layers, surroundings.layers(answer), bytes);
    std::this_thread::sleep_for(period);
  }
}

nlohmann::ordered_json summary(const Received& received, const Announcer& announcer,
                               const Answer& last) {
  nlohmann::ordered_json json{{"joint_states", received.joint_states},
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
  const ViscosityField field = open_input(options, err);
  cli::ArmOptions arm_options = options.arm;
  const auto ending = options.input.extension();
  if (arm_options.scene.empty() && (ending == ".yaml" || ending == ".yml")) {
    arm_options.scene = arm_options.robot.empty() ? options.input : std::filesystem::path();
  }
  const cli::Arm arm = cli::read_arm(arm_options);
  for (const std::string& remark : arm.remarks) err << "note: " << remark << '\n';
  const int tool = arm.teleoperation.tool_link;
  const cli::WhileWriting to_the_end;  // a signal asks the bridge to end

  dds::Participant participant(where);
  Teleoperation teleoperation(arm.robot, arm.points, field, arm.teleoperation);
  const auto loop = std::make_unique<ArmLoop>(teleoperation);
  Intake intake(arm.robot, arm.X_WB);
  Announcer announcer(participant, arm.robot, field, tool, options.half_speed_drag);
  Surroundings surroundings(arm.robot, arm.points, field, tool, options.world);
  std::unique_ptr<Recorder> recorder;
  if (!options.recording.empty()) {
    recorder = std::make_unique<Recorder>(options.recording, arm.robot, field, tool);
  }
  const Readers readers(participant);
  const dds_entity_t markers = participant.writer<ros2::MarkerArray>(ros2::topic::markers);
  const dds_entity_t layers =
      participant.writer<ros2::PointCloud2>(ros2::topic::layers, {.depth = 1});
  Newest newest;
  Received received;
  Answer answer;
  {
    std::jthread receiving([&](const std::stop_token& stop) {
      received = receive(readers, intake, *loop, options.world, stop);
    });
    std::jthread drawing(
        [&](const std::stop_token& stop) { draw(markers, layers, surroundings, newest, stop); });
    err << fmt::format("bridging {} joints of {} in domain {}{}\n", arm.robot.coordinates.size(),
                       arm.robot.name, options.domain,
                       options.dds.empty() ? ", on this machine alone" : "");
    err.flush();
    const Clock::time_point begin = Clock::now();
    const auto over = [&] {
      return options.seconds &&
             std::chrono::duration<double>(Clock::now() - begin).count() > *options.seconds;
    };
    while (!cli::interruption_asked() && !over()) {
      if (!loop->take(answer, static_cast<std::int64_t>(1e9 * wait_s))) continue;
      announcer.announce(answer);
      newest.put(answer);
      if (recorder != nullptr) recorder->add(answer);
    }
  }
  if (recorder != nullptr && !recorder->failure().empty()) {
    err << "note: " << recorder->failure() << '\n';
  }
  recorder.reset();
  const nlohmann::ordered_json json = summary(received, announcer, answer);
  out << (options.json ? json.dump(2) + '\n' : in_words(json));
  out.flush();
  return 0;
}

}  // namespace vicinity::bridge
