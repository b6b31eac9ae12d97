// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A replay's outcome, as people and as programs want it said.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "replay/arm.h"
#include "replay/loop.h"
#include "replay/recording.h"
#include "replay/statistics.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::cli {

/// All that a replay leaves behind.
struct ReplayOutcome {
  const ViscosityField& field;
  const Arm& arm;
  std::size_t points;  ///< of the arm's body
  Pace pace;
  double t_start;  ///< of the log [s]
  const Recording& recording;
  const LoopReport& loop;
  ReplayStatistics statistics;
};

/// @param output  the recording's file; empty: none
std::string replay_in_words(const ReplayOutcome& outcome, const std::filesystem::path& output);

/// Keys: ticks, seconds, joints, points, statuses{}, felt_share, strongest{t, force, link, object,
/// rank, distance_mm} or null, limiter{mode, limits{}, lowest_scale}, energy{drag, device, lowest,
/// passive, unaccounted}, points_felt{mean_share, most_share}, tick_us{p50, p99, p999, max,
/// bins[]}, real_time{...} or null, resident_bytes{start, end}, interrupted, remarks[].
nlohmann::ordered_json replay_as_json(const ReplayOutcome& outcome);

}  // namespace vicinity::cli
