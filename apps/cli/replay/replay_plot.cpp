// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/replay_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "picture/chart.h"
#include "picture/rank_palette.h"

namespace vicinity::cli {
namespace {

// Finer than this many columns, strips would not show.
constexpr std::size_t strip_columns = 1200;

double time_of(const ReplayOutcome& outcome, const TickRecord& tick) {
  return outcome.t_start + tick.time_s;
}

Colour colour_of(Status status) {
  switch (status) {
    case Status::ok:
      return {0.80, 0.92, 0.80};
    case Status::started:
      return {0.34, 0.71, 0.91};
    case Status::beyond_joint_limits:
      return {0.90, 0.62, 0.0};
    case Status::outside_field:
      return {0.93, 0.93, 0.93};
    case Status::deadline_missed:
      return {0.84, 0.20, 0.0};
    default:
      return {0.35, 0.12, 0.38};
  }
}

// How much the voxel that was felt says, and its colour: the nearer to a surface, the more.
VoxelRecord felt_voxel(const Reason& reason) {
  if (reason.object < 0) return {};
  return {.kind = reason.kind,
          .rank = static_cast<std::uint8_t>(reason.rank),
          .object = static_cast<std::uint16_t>(reason.object)};
}

int nearness(const VoxelRecord& voxel) {
  return voxel.kind == VoxelKind::empty       ? 0
         : voxel.kind == VoxelKind::neighbour ? 100 - voxel.rank
                                              : 200;
}

// Ticks as bands: of those that share a column, the one with the most to say.
std::vector<ChartBand> bands_of(const ReplayOutcome& outcome,
                                const std::function<int(const TickRecord&)>& weight,
                                const std::function<Colour(const TickRecord&)>& colour) {
  const auto ticks = outcome.recording.ticks();
  const std::size_t step = std::max<std::size_t>(1, ticks.size() / strip_columns);
  std::vector<ChartBand> bands;
  std::optional<int> last;
  for (std::size_t begin = 0; begin < ticks.size(); begin += step) {
    const std::size_t end = std::min(begin + step, ticks.size());
    const TickRecord& most = *std::max_element(
        ticks.begin() + static_cast<std::ptrdiff_t>(begin),
        ticks.begin() + static_cast<std::ptrdiff_t>(end),
        [&](const TickRecord& a, const TickRecord& b) { return weight(a) < weight(b); });
    const double to = time_of(outcome, ticks[std::min(end, ticks.size() - 1)]);
    if (last == weight(most)) {
      bands.back().to = to;
    } else {
      bands.push_back({time_of(outcome, ticks[begin]), to, colour(most)});
    }
    last = weight(most);
  }
  return bands;
}

ChartStrip felt_strip(const ReplayOutcome& outcome) {
  const int q = most_ranks(outcome.field);
  ChartStrip strip{.label = "felt", .bands = {}, .key = {}};
  strip.bands = bands_of(
      outcome, [](const TickRecord& tick) { return nearness(felt_voxel(tick.reason)); },
      [q](const TickRecord& tick) { return cli::colour_of(felt_voxel(tick.reason), q); });
  strip.key.emplace_back("nothing", white);
  for (int n = q; n >= 1; --n) strip.key.emplace_back(fmt::format("rank {}", n), rank_colour(n, q));
  strip.key.emplace_back("skin", boundary_colour);
  strip.key.emplace_back("inside", inner_colour);
  return strip;
}

ChartStrip status_strip(const ReplayOutcome& outcome) {
  ChartStrip strip{.label = "status", .bands = {}, .key = {}};
  strip.bands = bands_of(
      outcome, [](const TickRecord& tick) { return static_cast<int>(tick.status); },
      [](const TickRecord& tick) { return colour_of(tick.status); });
  for (const auto& [status, count] : outcome.statistics.statuses) {
    strip.key.emplace_back(to_string(status), colour_of(status));
  }
  return strip;
}

Series series_of(const ReplayOutcome& outcome, const std::string& name,
                 const std::function<double(std::size_t)>& value) {
  Series series{.name = name, .points = {}, .steps = true};
  const auto ticks = outcome.recording.ticks();
  series.points.reserve(ticks.size());
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    series.points.emplace_back(time_of(outcome, ticks[k]), value(k));
  }
  return series;
}

ChartPanel torques(const ReplayOutcome& outcome) {
  ChartPanel panel{.y_label = "joint torque [N·m]", .series = {}};
  bool slides = false;
  for (std::size_t c = 0; c < outcome.recording.joints(); ++c) {
    slides |=
        outcome.arm.robot.joints[static_cast<std::size_t>(outcome.arm.robot.coordinates[c])].type ==
        JointType::prismatic;
    panel.series.push_back(series_of(outcome, joint_name(outcome.arm.robot, c), [&](std::size_t k) {
      return outcome.recording.torque(k)[c];
    }));
  }
  if (slides) panel.y_label = "joint torque or force [N·m, N]";
  return panel;
}

ChartPanel forces(const ReplayOutcome& outcome) {
  const auto ticks = outcome.recording.ticks();
  return {.y_label = "force [N]",
          .series = {
              series_of(outcome, "all drag |F|",
                        [&](std::size_t k) { return ticks[k].tool.force.norm(); }),
              series_of(outcome, "master", [&](std::size_t k) { return ticks[k].master_force; })}};
}

ChartPanel distance(const ReplayOutcome& outcome) {
  const auto ticks = outcome.recording.ticks();
  return {.y_label = "distance, at least [mm]",
          .series = {series_of(outcome, "distance", [&](std::size_t k) {
            const Reason& reason = ticks[k].reason;
            return reason.object < 0 ? std::numeric_limits<double>::quiet_NaN()
                                     : 1000 * reason.distance_m;
          })}};
}

}  // namespace

void plot_replay(const ReplayOutcome& outcome, const std::filesystem::path& field,
                 const std::filesystem::path& trajectory, const std::filesystem::path& picture) {
  draw_chart(
      {.title = "What the operator would feel",
       .caption = fmt::format(
           "{} in {}, {} with {} points, ticks at {:g} Hz. Limiter: {}. Distance: of the "
           "point that feels most, from what it feels; a gap where none feels anything. Strips: "
           "its voxel, and the worst status.",
           trajectory.filename().string(), field.filename().string(), outcome.arm.robot.name,
           outcome.points, outcome.pace.rate, outcome.arm.limiter),
       .x_label = "time [s]",
       .panels = {torques(outcome), forces(outcome), distance(outcome)},
       .strips = {felt_strip(outcome), status_strip(outcome)}},
      picture);
}

}  // namespace vicinity::cli
