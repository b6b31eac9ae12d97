// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/bench_tick.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "arguments.h"
#include "progress_bar.h"
#include "readable.h"
#include "replay/statistics.h"
#include "scenes/hot_cell.h"
#include "vicinity/teleop/tick.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::cli {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

// The demo's arm is bent over between bench, risers and vessel.
const std::vector<double> hot_cell_pose{0.1, 0.9, 0.3, 0.9, 0.2, 0.4, 0.0};
constexpr std::size_t warm_up = 200;
constexpr std::size_t most_ticks = 1'000'000;

double microseconds(Clock::duration d) {
  return std::chrono::duration<double, std::micro>(d).count();
}

/// Every joint sways, each at its own rate, about the middle of its range.
class Sway {
 public:
  explicit Sway(const RobotModel& robot, const std::vector<double>& pose) : pose_(pose) {
    for (std::size_t c = 0; c < robot.coordinates.size(); ++c) {
      const Joint& joint = robot.joints[static_cast<std::size_t>(robot.coordinates[c])];
      const double usual = joint.type == JointType::prismatic ? 0.05 : 0.15;  // [m], [rad]
      size_.push_back(std::min(usual, 0.25 * (joint.limits.upper - joint.limits.lower)));
      if (c < pose.size()) continue;
      const double middle = 0.5 * (joint.limits.lower + joint.limits.upper);
      pose_.push_back(std::isfinite(middle) ? middle : 0);
    }
    q_.resize(size_.size());
    qd_.resize(size_.size());
  }

  Input at(double t, const Pose& X_WB) {
    for (std::size_t c = 0; c < q_.size(); ++c) {
      const double rate = 1 + 0.13 * static_cast<double>(c);
      const double phase = rate * t + static_cast<double>(c);
      q_[c] = pose_[c] + size_[c] * std::sin(phase);
      qd_[c] = size_[c] * rate * std::cos(phase);
    }
    return {.time_s = t,
            .q = q_.data(),
            .qd = qd_.data(),
            .joint_count = static_cast<int>(q_.size()),
            .X_WB = X_WB};
  }

 private:
  std::vector<double> pose_, size_, q_, qd_;
};

// Arithmetic that waits for nothing but itself. How many rounds fit into a time is measured.
class EmptyLoop {
 public:
  explicit EmptyLoop(double length_us) {
    constexpr std::uint64_t trial = 1 << 16;
    double best = microseconds(Clock::duration::max());
    for (int n = 0; n < 20; ++n) best = std::min(best, run(trial));
    rounds_ =
        static_cast<std::uint64_t>(std::max(1.0, static_cast<double>(trial) * length_us / best));
  }
  double run() { return run(rounds_); }  // [µs]

 private:
  double run(std::uint64_t rounds) {
    const Clock::time_point start = Clock::now();
    std::uint64_t x = state_;
    for (std::uint64_t n = 0; n < rounds; ++n) x = x * 6364136223846793005u + 1442695040888963407u;
    const double took = microseconds(Clock::now() - start);
    state_ = x;  // a member, so that no compiler can leave the loop out
    return took;
  }
  volatile std::uint64_t state_ = 1;
  std::uint64_t rounds_ = 1;
};

using Times = std::vector<double>;  // [µs], in rising order once all are in

struct TickCost {
  std::size_t points = 0;
  Times ticks, empty;
  std::size_t over_deadline = 0;
  double looked = 0, felt = 0;  // shares of the points, in the mean
};

TickCost measure(const Arm& arm, const ViscosityField& field, Sway sway, std::size_t points,
                 double seconds, ProgressBar& progress) {
  const std::string label = grouped(points) + " points";
  progress.show(label, 0);
  Teleoperation teleoperation(arm.robot, sample_body_points(arm.robot, {.total = points}), field,
                              arm.teleoperation);
  Output output;
  std::size_t k = 0;
  const auto tick = [&] {
    const Input input = sway.at(static_cast<double>(k++) / arm.rate, arm.X_WB);
    const Clock::time_point start = Clock::now();
    (void)teleoperation.tick(input, output);
    return microseconds(Clock::now() - start);
  };
  Times first;
  for (std::size_t n = 0; n < warm_up; ++n) first.push_back(tick());
  std::ranges::sort(first);

  TickCost cost;
  cost.points = points;
  cost.ticks.reserve(most_ticks);
  cost.empty.reserve(most_ticks);
  EmptyLoop empty(quantile(first, 0.5));
  const Clock::time_point begin = Clock::now();
  double gone_s = 0;
  while (gone_s < seconds && cost.ticks.size() < most_ticks) {
    cost.ticks.push_back(tick());
    cost.empty.push_back(empty.run());
    cost.looked += output.counts.points_looked;
    cost.felt += output.counts.points_felt;
    gone_s = microseconds(Clock::now() - begin) * 1e-6;
    if (cost.ticks.size() % 256 == 0) progress.show(label, gone_s / seconds);
  }
  const double all = static_cast<double>(points) * static_cast<double>(cost.ticks.size());
  cost.looked /= all;
  cost.felt /= all;
  std::ranges::sort(cost.ticks);
  std::ranges::sort(cost.empty);
  cost.over_deadline = static_cast<std::size_t>(
      cost.ticks.end() - std::upper_bound(cost.ticks.begin(), cost.ticks.end(), 1e6 / arm.rate));
  return cost;
}

std::vector<std::size_t> point_counts(const std::string& text) {
  std::vector<std::size_t> counts;
  for (const double n : numbers_from("--points", text)) {
    if (!(n >= 1 && n <= static_cast<double>(BodyPoints::most)) || n != std::floor(n)) {
      throw Error({.where = "--points",
                   .what = "is no number of points",
                   .found = fmt::format("{:g}", n),
                   .expected = "whole numbers from 1 to " + grouped(BodyPoints::most),
                   .hint = "1000,100000"});
    }
    counts.push_back(static_cast<std::size_t>(n));
  }
  return counts;
}

Json as_json(const std::vector<TickCost>& costs) {
  Json json = Json::array();
  for (const TickCost& cost : costs) {
    json.push_back({{"points", cost.points},
                    {"ticks", cost.ticks.size()},
                    {"p50_us", quantile(cost.ticks, 0.5)},
                    {"p99_us", quantile(cost.ticks, 0.99)},
                    {"p999_us", quantile(cost.ticks, 0.999)},
                    {"p9999_us", quantile(cost.ticks, 0.9999)},
                    {"max_us", cost.ticks.back()},
                    {"over_deadline", cost.over_deadline},
                    {"looked", cost.looked},
                    {"felt", cost.felt},
                    {"empty_loop",
                     {{"p50_us", quantile(cost.empty, 0.5)},
                      {"p999_us", quantile(cost.empty, 0.999)},
                      {"p9999_us", quantile(cost.empty, 0.9999)},
                      {"max_us", cost.empty.back()}}}});
  }
  return json;
}

std::string in_words(const std::vector<TickCost>& costs, double rate) {
  std::string text = fmt::format(
      "Microseconds a tick, of the {:g} that a period has\n\n"
      "{:>9} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7} | {:>9} {:>9} {:>9}\n",
      1e6 / rate, "points", "felt", "ticks", "p50", "p99", "p99.99", "worst", "late", "empty p50",
      "p99.99", "worst");
  for (const TickCost& cost : costs) {
    text += fmt::format(
        "{:>9} {:>5.0f}% {:>9} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>7} | {:>9.1f} {:>9.1f} "
        "{:>9.1f}\n",
        grouped(cost.points), 100 * cost.felt, grouped(cost.ticks.size()),
        quantile(cost.ticks, 0.5), quantile(cost.ticks, 0.99), quantile(cost.ticks, 0.9999),
        cost.ticks.back(), grouped(cost.over_deadline), quantile(cost.empty, 0.5),
        quantile(cost.empty, 0.9999), cost.empty.back());
  }
  text +=
      "\nfelt: points in a layer, in the mean. late: ticks longer than a period. The empty loop "
      "ran "
      "between\nthe ticks and should take as long every time: where it does not, the machine was "
      "busy elsewhere.\n";
  return text;
}

}  // namespace

int bench_tick(const BenchTickOptions& options, std::ostream& out, std::ostream& err) {
  const std::vector<std::size_t> counts = point_counts(options.points);
  if (!(options.seconds > 0 && std::isfinite(options.seconds))) {
    throw Error({.where = "--seconds",
                 .what = "is no time to measure for",
                 .found = fmt::format("{:g}", options.seconds)});
  }
  const bool embedded = options.field.empty();
  if (embedded && !(options.arm.robot.empty() && options.arm.scene.empty())) {
    throw Error({.what = "an arm of one's own needs a field of one's own",
                 .hint = "vicinity bench tick FIELD --robot arm.urdf"});
  }
  const Arm arm = embedded ? hot_cell_arm(options.arm) : read_arm(options.arm);
  std::vector<TickCost> costs;
  {
    ProgressBar progress(err);
    progress.show("field", 0);
    const ViscosityField field =
        embedded ? build_field(parse_scene(hot_cell_scene, {}, "the hot cell")).field
                 : open_field(options.field);
    const Sway sway(arm.robot, embedded ? hot_cell_pose : std::vector<double>{});
    for (const std::size_t points : counts) {
      costs.push_back(measure(arm, field, sway, points, options.seconds, progress));
    }
  }
  if (options.json) {
    out << as_json(costs).dump(2) << '\n';
  } else {
    out << in_words(costs, arm.rate);
  }
  return 0;
}

}  // namespace vicinity::cli
