// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a replay came to: what was felt, what the limiter did, and what the ticks cost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "replay/recording.h"

namespace vicinity::cli {

/// The smallest value that a share of all values does not exceed (nearest rank).
/// @param rising  in rising order, not empty
/// @param share   0..1
double quantile(std::span<const double> rising, double share);

/// Times of all ticks, sorted into bins whose edges rise as 1, 2, 5, 10, ...
struct TimeHistogram {
  struct Bin {
    double from_us = 0, to_us = 0;  ///< [from, to) [µs]
    std::uint64_t ticks = 0;
  };
  std::vector<Bin> bins;  ///< from the first that holds any tick to the last
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;
};

/// Missed deadlines by cause: what the longer part of the delay was.
struct Misses {
  std::uint64_t late_wake_ups = 0;  ///< the system woke the loop too late
  std::uint64_t long_ticks = 0;     ///< the tick before took too long
  double worst_wake_us = 0, worst_tick_us = 0;
};

struct ReplayStatistics {
  std::map<Status, std::uint64_t> statuses;
  std::optional<std::size_t> strongest;  ///< tick with the largest force; absent: none was felt
  std::uint64_t felt = 0;                ///< ticks with force
  double mean_points_felt = 0;
  std::uint32_t most_points_felt = 0;
  std::map<DragLimit, std::uint64_t>
      limits;               ///< ticks by what held their drag down, `none` left out
  double lowest_scale = 1;  ///< over the ticks that felt anything
  TimeHistogram times;
  Misses misses;
};

/// @param ticks  not empty
ReplayStatistics statistics_of(std::span<const TickRecord> ticks);

}  // namespace vicinity::cli
