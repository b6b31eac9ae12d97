// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The arm in the operator's hand, and whoever checks what it is told to feel.
//
//   two_machines_arm DDS_XML SCENE SCENE...
//
// Publishes joint states of the scenes' arm at 1 kHz as /master/joint_states, for the bridge on its
// own machine, and as /slave/joint_states, for the one at the other end of the way. Of the torques
// that come back each must be zero, or what an oracle finds in the field that was shared then.
// Events come on standard input, one a line, and all ends with it:
//
//   scene N          the N-th scene (0 is the first, from the start) has been written
//   start SIDE       a bridge is being started: master, slave
//   kill SIDE        it has been killed
//
// Says what it saw, and exits with 1 where a torque was wrong or the audit went below zero.

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <deque>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "dds/participant.h"
#include "oracle.h"
#include "ros2/messages.h"
#include "ros2/topics.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::two_machines {
namespace {

constexpr std::int64_t period_ns = 1'000'000;
// Whoever renders a torque drops it where none comes for so long: as the bridge does.
constexpr int hold_ticks = 20;

std::int64_t since_1970_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}
std::int64_t ns_of(const ros2::Time& stamp) { return stamp.sec * 1'000'000'000LL + stamp.nanosec; }

// A smooth motion through the layers of the hot cell, never at rest for long.
struct Motion {
  explicit Motion(std::size_t joints) : joints(joints) {}
  void at(double t, std::vector<double>& q, std::vector<double>& qd) const {
    q.assign(joints, 0);
    qd.assign(joints, 0);
    for (std::size_t c = 0; c < joints; ++c) {
      const double centre = c < 7 ? start[c] : 0, w = 1.1 + 0.37 * static_cast<double>(c);
      q[c] = centre + 0.12 * std::sin(w * t);
      qd[c] = 0.12 * w * std::cos(w * t);
    }
  }
  static constexpr double start[7] = {0.08, -0.15, 0, 2.416, 0, -0.695, 0};
  std::size_t joints;
};

struct Times {
  std::vector<double> seconds;
  void print(const char* what) {
    if (seconds.empty()) return;
    std::ranges::sort(seconds);
    std::printf("  %s, %zu times: min %.2f, median %.2f, max %.2f s\n", what, seconds.size(),
                seconds.front(), seconds[seconds.size() / 2], seconds.back());
  }
};

// One bridge, as its answers show it.
struct Side {
  std::string name;
  dds_entity_t states = 0, efforts = 0, diagnostics = 0;

  std::uint64_t answers = 0, right = 0, free = 0, safe = 0, wrong = 0, unexplained = 0, unknown = 0;
  std::map<std::string, std::uint64_t> safe_by_status;
  std::size_t scene_change = 0;  // the youngest change of scene that was felt
  std::optional<double> started_s;
  Times rejoins, changes_felt;
  // A torque acts from its own state to the next that is answered, as the tick's own audit has it.
  std::int64_t last_k = -1;
  std::vector<double> last_torque;
  double energy = 0, lowest_energy = 0;
  // Zeros that wait for the status that explains them, by stamp.
  std::deque<std::int64_t> zeros;
  std::map<std::int64_t, std::string> statuses;
};

class MasterArm {
 public:
  MasterArm(const char* dds_file, const std::vector<std::string>& scenes)
      : arm_(arm_of(scenes.front())),
        oracle_(arm_),
        motion_(arm_.robot.coordinates.size()),
        participant_(
            {.domain = 0, .configuration = std::string("file://") + dds_file, .name_space = {}}) {
    FieldBuilder builder;
    for (const std::string& scene : scenes)
      fields_.push_back(builder.build(read_scene(scene)).field);
    for (const char* name : {"master", "slave"}) {
      const std::string in = std::string("/") + name;
      Side& side = sides_.emplace_back();
      side.name = name;
      side.states =
          participant_.writer<ros2::JointState>(in + std::string(ros2::topic::joint_states));
      side.efforts = participant_.reader<ros2::JointState>(
          in + std::string(ros2::topic::joint_efforts), {.reliable = false, .depth = 1000});
      side.diagnostics = participant_.reader<ros2::DiagnosticArray>(
          in + std::string(ros2::topic::diagnostics), {.depth = 1000});
    }
    for (std::size_t c = 0; c < arm_.robot.coordinates.size(); ++c) {
      names_.push_back(cli::joint_name(arm_.robot, c));
    }
  }

  int run() {
    begin_ns_ = since_1970_ns();
    begin_ = Clock::now();
    changes_ = {{0, 0.0}};
    std::thread publishing([this] { publish(); });
    std::vector<dds_entity_t> readers;
    for (const Side& side : sides_) readers.insert(readers.end(), {side.efforts, side.diagnostics});
    const dds::Participant::Waiter waiter(participant_, readers);
    while (!done_) {
      waiter.wait(0.02);
      hear_events();
      for (Side& side : sides_) hear(side);
    }
    publishing.join();
    for (Side& side : sides_) explain(side, since_1970_ns());
    return report();
  }

 private:
  using Clock = std::chrono::steady_clock;

  static cli::Arm arm_of(const std::string& scene) {
    cli::ArmOptions options;
    options.scene = scene;
    return cli::read_arm(options);
  }
  double now_s() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  // 1 kHz, stamped with when each was due.
  void publish() {
    ros2::JointState state;
    state.name = names_;
    dds::Sample bytes;
    std::vector<double> q, qd, next, rendered(names_.size(), 0);
    for (std::int64_t k = 0; !ending_; ++k) {
      std::this_thread::sleep_until(begin_ + std::chrono::nanoseconds(k * period_ns));
      const std::int64_t stamp = begin_ns_ + k * period_ns;
      state.header.stamp = {static_cast<std::int32_t>(stamp / 1'000'000'000),
                            static_cast<std::uint32_t>(stamp % 1'000'000'000)};
      motion_.at(1e-9 * static_cast<double>(k * period_ns), q, qd);
      state.position = q;
      state.velocity = qd;
      states_ = k + 1;
      for (const Side& side : sides_) (void)dds::send(side.states, state, bytes);
      // What the hand feels until the next period: the newest torque from its own machine.
      {
        const std::lock_guard lock(mutex_);
        rendered = newest_;
        if (++newest_age_ > hold_ticks) std::ranges::fill(rendered, 0.0);
      }
      motion_.at(1e-9 * static_cast<double>((k + 1) * period_ns), next, qd);
      for (std::size_t c = 0; c < rendered.size(); ++c) {
        rendered_energy_ -= rendered[c] * (next[c] - q[c]);
      }
      lowest_rendered_ = std::min(lowest_rendered_, rendered_energy_);
    }
    std::this_thread::sleep_for(std::chrono::seconds(2));  // for what is still under way
    done_ = true;
  }

  void hear_events() {
    pollfd waiting{STDIN_FILENO, POLLIN, 0};
    while (!ending_ && poll(&waiting, 1, 0) > 0) {
      char c = 0;
      if (read(STDIN_FILENO, &c, 1) != 1) {
        ending_ = true;
        return;
      }
      if (c != '\n') {
        line_ += c;
        continue;
      }
      std::istringstream words(line_);
      std::string event, what;
      words >> event >> what;
      line_.clear();
      if (event == "scene") changes_.push_back({std::stoul(what), now_s()});
      for (Side& side : sides_) {
        if (what != side.name) continue;
        if (event == "start") side.started_s = now_s();
        if (event == "kill") ++kills_;
      }
    }
  }

  void hear(Side& side) {
    ros2::DiagnosticArray diagnostics;
    while (dds::take(side.diagnostics, bytes_)) {
      if (!ros2::read_cdr(bytes_, diagnostics)) continue;
      for (const ros2::DiagnosticStatus& status : diagnostics.status) {
        if (status.name == "vicinity: drag") {
          side.statuses[ns_of(diagnostics.header.stamp)] = status.message;
        }
      }
    }
    ros2::JointState answer;
    while (dds::take(side.efforts, bytes_)) {
      if (!ros2::read_cdr(bytes_, answer)) continue;
      if (side.name == "master") {
        const std::lock_guard lock(mutex_);
        newest_ = answer.effort;
        newest_age_ = 0;
      }
      judge(side, ns_of(answer.header.stamp), answer.effort);
    }
    explain(side, since_1970_ns() - 3'000'000'000);
  }

  void judge(Side& side, std::int64_t stamp, const std::vector<double>& torque) {
    ++side.answers;
    const std::int64_t k = (stamp - begin_ns_) / period_ns;
    const bool ours = (stamp - begin_ns_) % period_ns == 0 && k >= 0 && k < states_;
    if (is_zero(torque)) {
      ++side.safe;
      if (ours) side.zeros.push_back(stamp);
      audit(side, k, torque);
      return;
    }
    if (!ours) {  // a force, and for no state of ours
      ++side.unknown;
      return;
    }
    std::vector<double> q, qd;
    motion_.at(1e-9 * static_cast<double>(k * period_ns), q, qd);
    bool found = false;
    for (std::size_t n = side.scene_change; n < changes_.size() && !found; ++n) {
      found = is(torque, oracle_.drag(fields_[changes_[n].first], q, qd));
      if (found && n > side.scene_change) {
        side.changes_felt.seconds.push_back(now_s() - changes_[n].second);
        side.scene_change = n;
      }
    }
    ++(found ? side.right : side.wrong);
    if (!found && side.wrong <= 5) {
      const Drag drag = oracle_.drag(fields_[changes_.back().first], q, qd);
      std::fprintf(stderr, "%s, state %lld: a wrong torque:", side.name.c_str(),
                   static_cast<long long>(k));
      for (std::size_t c = 0; c < torque.size(); ++c) {
        std::fprintf(stderr, " %.9g (%.9g)", torque[c], drag.torque[c]);
      }
      std::fprintf(stderr, "\n");
    }
    if (found && side.started_s && static_cast<double>(stamp - begin_ns_) > 1e9 * *side.started_s) {
      side.rejoins.seconds.push_back(now_s() - *side.started_s);
      side.started_s.reset();
    }
    audit(side, k, torque);
  }

  void audit(Side& side, std::int64_t k, const std::vector<double>& torque) {
    std::vector<double> from, to, qd;
    if (side.last_k >= 0 && k > side.last_k) {
      motion_.at(1e-9 * static_cast<double>(side.last_k * period_ns), from, qd);
      const std::int64_t until = std::min<std::int64_t>(k, side.last_k + hold_ticks);
      motion_.at(1e-9 * static_cast<double>(until * period_ns), to, qd);
      for (std::size_t c = 0; c < from.size(); ++c) {
        side.energy -= side.last_torque[c] * (to[c] - from[c]);
      }
      side.lowest_energy = std::min(side.lowest_energy, side.energy);
    }
    if (k >= side.last_k) {
      side.last_k = k;
      side.last_torque = torque;
    }
  }

  // Zeros are named by the status that was said last, up to them.
  void explain(Side& side, std::int64_t before_ns) {
    while (!side.zeros.empty() && side.zeros.front() < before_ns) {
      const std::int64_t stamp = side.zeros.front();
      side.zeros.pop_front();
      const auto after = side.statuses.upper_bound(stamp);
      const std::string status = after == side.statuses.begin() ? "" : std::prev(after)->second;
      const bool felt = status == "ok" || status == "beyond joint limits" || status.empty();
      if (!felt) {
        ++side.safe_by_status[status];
        continue;
      }
      // Nothing to feel there is a reason too.
      std::vector<double> q, qd;
      motion_.at(1e-9 * static_cast<double>(stamp - begin_ns_), q, qd);
      bool nothing = false;
      for (const auto& [scene, when] : changes_) {
        nothing = nothing || is_zero(oracle_.drag(fields_[scene], q, qd).torque);
      }
      ++(nothing ? side.free : side.unexplained);
    }
  }

  int report() {
    const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    std::printf("%lld states at 1 kHz; %llu kills, %zu changes of the scene\n",
                static_cast<long long>(states_), number(kills_), changes_.size() - 1);
    bool good = lowest_rendered_ >= 0;
    for (Side& side : sides_) {
      good =
          good && side.wrong == 0 && side.unknown == 0 && side.lowest_energy >= 0 && side.right > 0;
      std::printf("%s: %llu answers, %llu as the oracle has it, %llu zero, %llu wrong\n",
                  side.name.c_str(), number(side.answers), number(side.right), number(side.safe),
                  number(side.wrong + side.unknown));
      std::printf("  zero:");
      for (const auto& [status, count] : side.safe_by_status) {
        std::printf(" %llu %s,", number(count), status.c_str());
      }
      std::printf(" %llu where there is nothing, %llu whose status was lost\n", number(side.free),
                  number(side.unexplained));
      std::printf("  energy taken out %.6f J, at its lowest %.6f J\n", side.energy,
                  side.lowest_energy);
      side.rejoins.print("from a start to the first force");
      side.changes_felt.print("from a change of the scene to its first force");
    }
    std::printf("rendered at the hand: energy taken out %.6f J, at its lowest %.6f J\n",
                rendered_energy_, lowest_rendered_);
    return good ? 0 : 1;
  }

  cli::Arm arm_;
  Oracle oracle_;
  Motion motion_;
  dds::Participant participant_;
  std::vector<ViscosityField> fields_;
  std::vector<Side> sides_;
  std::vector<std::string> names_;
  std::int64_t begin_ns_ = 0;
  Clock::time_point begin_;
  std::vector<std::pair<std::size_t, double>> changes_;  // scene, when [s]
  std::uint64_t kills_ = 0;
  dds::Sample bytes_;
  std::string line_;
  std::atomic<std::int64_t> states_ = 0;  // published so far
  std::atomic<bool> ending_ = false, done_ = false;
  // What the hand renders: heard by one thread, used by the other.
  std::mutex mutex_;
  std::vector<double> newest_;
  int newest_age_ = 0;
  double rendered_energy_ = 0, lowest_rendered_ = 0;
};

}  // namespace
}  // namespace vicinity::two_machines

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  try {
    return vicinity::two_machines::MasterArm(argv[1], {argv + 2, argv + argc}).run();
  } catch (const std::exception& error) {
    std::cerr << "two_machines_arm: " << error.what() << '\n';
    return 2;
  }
}
