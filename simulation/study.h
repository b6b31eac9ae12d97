// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The whole study: every aid tuned, then compared on the same operators, tasks and delays.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/estimate.h"
#include "simulation/trial.h"

namespace vicinity {

struct StudyOptions {
  int trials = 200;  ///< of each cell
  std::uint64_t seed = 1;
  int threads = 0;                                        ///< 0: as many as the machine has
  std::vector<std::string> methods = {};                  ///< only these; empty: all
  std::vector<double> delays_s = {0.02, 0.05, 0.1, 0.2};  ///< there and back [s]
  int tuning_trials = 20;                                 ///< of each setting and tuning task
  /// What goes on, and how much of the whole is done, 0..1. From any thread, one at a time.
  std::function<void(std::string_view what, double done)> progress = nullptr;
  /// Asked now and then; true ends the study early with what there is.
  std::function<bool()> stop = nullptr;
};

/// Which question a cell belongs to.
enum class Part : std::uint8_t {
  tasks,    ///< every aid at every task, no delay
  delay,    ///< the first task under delay; the aid is computed beside the slave
  beside,   ///< the same, the aid computed beside the master
  strict,   ///< drag within the device's own damping, under delay, beside the slave
  devices,  ///< drag on devices that bear less
};

/// "tasks", "delay", ...
const char* to_string(Part part) noexcept;

/// What 200 trials say.
struct Summary {
  int trials = 0;
  Estimate touched, finished;         ///< shares
  Estimate impact_speed, peak_force;  ///< of the trials that touched
  Estimate overshoot_m, miss_m, time_s, effort, clearance_m, pushed_j;
  Estimate given_j;                 ///< mean of what the aid gave beyond what it had taken
  double most_given_j = 0;          ///< of any trial
  double most_beyond_device_j = 0;  ///< and beyond what the device's own damping had eaten
  int gave = 0;                     ///< trials in which it gave more than a tenth of a millijoule
  int blew_up = 0;
};

struct Cell {
  Part part = Part::tasks;
  std::size_t task = 0;
  Method method;
  Condition condition;
};

struct CellResult {
  Cell cell;
  Training trained;
  Summary summary;
  std::vector<TrialResult> trials;
};

struct TunedSetting {
  double setting = 0, cost = 0;
  Estimate touched, time_s;
};

struct Tuning {
  std::string method;
  std::vector<TunedSetting> tried;
  std::size_t best = 0;
};

struct StudyResult {
  std::vector<Tuning> tunings;
  std::vector<CellResult> cells;
  bool stopped = false;
};

/// What tuning makes small: seconds to the end; two more for a touch, and one for each 10 mm/s of
/// its speed. One rule for all.
double cost_of(const TrialResult& result);

Summary summary_of(const std::vector<TrialResult>& trials);

/// Errors: throws Error for unknown methods, no trials, and delays that are none.
void check(const StudyOptions& options);

/// The cells of a study with these settings, in the order of the report.
std::vector<Cell> cells_of(const std::vector<Task>& tasks, const std::vector<Method>& tuned,
                           const StudyOptions& options);

/// Tunes each aid on the first two tasks with operators of their own, then runs all cells. The
/// result depends on the seed, and neither on the number of threads nor on their luck.
/// Errors: as check().
StudyResult run_study(const Workplace& place, const std::vector<Task>& tasks,
                      const StudyOptions& options);

}  // namespace vicinity
