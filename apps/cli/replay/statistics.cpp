// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vicinity::cli {
namespace {

TimeHistogram histogram_of(std::span<const TickRecord> ticks) {
  std::vector<double> sorted;
  for (const TickRecord& tick : ticks) sorted.push_back(tick.tick_us);
  std::ranges::sort(sorted);
  TimeHistogram histogram{.bins = {},
                          .p50_us = quantile(sorted, 0.5),
                          .p99_us = quantile(sorted, 0.99),
                          .p999_us = quantile(sorted, 0.999),
                          .max_us = sorted.back()};
  constexpr std::array steps = {1, 2, 5};
  auto at = sorted.begin();
  for (double decade = 0.01; at != sorted.end(); decade *= 10) {
    for (std::size_t n = 0; n < steps.size() && at != sorted.end(); ++n) {
      const double to = n + 1 < steps.size() ? decade * steps[n + 1] : 10 * decade;
      const bool first = decade == 0.01 && n == 0;
      const auto end = std::lower_bound(at, sorted.end(), to);
      if (end != at || !histogram.bins.empty()) {
        histogram.bins.push_back(
            {first ? 0 : decade * steps[n], to, static_cast<std::uint64_t>(end - at)});
      }
      at = end;
    }
  }
  return histogram;
}

Misses misses_of(std::span<const TickRecord> ticks) {
  Misses misses;
  for (std::size_t k = 1; k < ticks.size(); ++k) {
    if (ticks[k].status != Status::deadline_missed) continue;
    const double wake = ticks[k].late_us, tick = ticks[k - 1].tick_us;
    // A loop that is still busy with the last tick cannot wake in time for the next one.
    ++(tick > wake ? misses.long_ticks : misses.late_wake_ups);
    misses.worst_wake_us = std::max(misses.worst_wake_us, wake);
    misses.worst_tick_us = std::max(misses.worst_tick_us, tick);
  }
  return misses;
}

}  // namespace

double quantile(std::span<const double> rising, double share) {
  const double rank = std::ceil(share * static_cast<double>(rising.size()));
  return rising[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

ReplayStatistics statistics_of(std::span<const TickRecord> ticks) {
  ReplayStatistics statistics;
  double most = 0, points = 0;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const TickRecord& tick = ticks[k];
    ++statistics.statuses[tick.status];
    points += tick.points_felt;
    statistics.most_points_felt = std::max(statistics.most_points_felt, tick.points_felt);
    if (tick.limit != DragLimit::none) ++statistics.limits[tick.limit];
    const double force = tick.tool.force.norm();
    if (!(force > 0)) continue;
    ++statistics.felt;
    statistics.lowest_scale = std::min(statistics.lowest_scale, tick.scale);
    if (force <= most) continue;
    most = force;
    statistics.strongest = k;
  }
  statistics.mean_points_felt = points / static_cast<double>(ticks.size());
  statistics.times = histogram_of(ticks);
  statistics.misses = misses_of(ticks);
  return statistics;
}

}  // namespace vicinity::cli
