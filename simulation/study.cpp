// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/study.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

constexpr int block = 25;  // trials that share what one cell needs to be set up
constexpr double touch_cost_s = 2, speed_cost_s = 100;  // a touch, and for each m/s of it
constexpr double noticeable_j = 1e-4;
constexpr std::uint64_t tuning_operators = 1'000'000;  // none of them comes again in the study

struct Tally {
  int trials = 0, touched = 0;
};

// Trials of many cells, on all threads; results lie where they belong.
class Runner {
 public:
  Runner(const Workplace& place, const std::vector<Task>& tasks, const StudyOptions& options)
      : place_(place),
        tasks_(tasks),
        options_(options),
        arena_(options.threads > 0 ? options.threads : tbb::task_arena::automatic) {}

  std::vector<CellResult> run(const std::vector<Cell>& cells, int trials, std::uint64_t operators,
                              double from, double to) {
    std::vector<CellResult> results(cells.size());
    std::vector<std::size_t> units;
    const auto blocks = static_cast<std::size_t>((trials + block - 1) / block);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      results[c].cell = cells[c];
      results[c].trials.resize(static_cast<std::size_t>(trials));
      for (std::size_t b = 0; b < blocks; ++b) units.push_back(c * blocks + b);
    }
    done_ = 0;
    std::vector<Tally> tallies(cells.size());
    const std::size_t all = cells.size() + units.size();
    each(cells.size(), [&](std::size_t c) {
      Trial trial(place_, tasks_[cells[c].task], cells[c].method, cells[c].condition);
      results[c].trained = trial.train();
      show("training", from, to, all);
    });
    each(units.size(), [&](std::size_t u) {
      const std::size_t c = units[u] / blocks, first = units[u] % blocks * block;
      const Cell& cell = cells[c];
      Trial trial(place_, tasks_[cell.task], cell.method, cell.condition);
      const std::size_t last = std::min(first + block, static_cast<std::size_t>(trials));
      Tally ran;
      for (std::size_t n = first; n < last && !stopped(); ++n) {
        results[c].trials[n] =
            trial.run(seed_for(options_.seed, operators + n), results[c].trained);
        ++ran.trials;
        ran.touched += results[c].trials[n].touched ? 1 : 0;
      }
      show(so_far(cell, ran, tallies[c]), from, to, all);
    });
    for (CellResult& result : results) result.summary = summary_of(result.trials);
    return results;
  }

  bool stopped() {
    if (!stopped_ && options_.stop && options_.stop()) stopped_ = true;
    return stopped_;
  }

 private:
  template <class Work>
  void each(std::size_t count, const Work& work) {
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t n) {
        if (!stopped()) work(n);
      });
    });
  }

  // What a cell says with these trials more.
  std::string so_far(const Cell& cell, const Tally& ran, Tally& tally) {
    const std::lock_guard lock(mutex_);
    tally.trials += ran.trials;
    tally.touched += ran.touched;
    return fmt::format("{}, {}: {} of {} touched", tasks_[cell.task].name, cell.method.name,
                       tally.touched, tally.trials);
  }

  void show(std::string_view what, double from, double to, std::size_t all) {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (!options_.progress) return;
    options_.progress(what,
                      from + (to - from) * static_cast<double>(done_) / static_cast<double>(all));
  }

  const Workplace& place_;
  const std::vector<Task>& tasks_;
  const StudyOptions& options_;
  tbb::task_arena arena_;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::atomic<bool> stopped_{false};
};

std::vector<Method> chosen(const StudyOptions& options) {
  if (options.methods.empty()) return methods();
  std::vector<Method> some;
  for (const std::string& name : options.methods) some.push_back(method_named(name));
  return some;
}

std::vector<Tuning> tune(Runner& runner, const std::vector<Task>& tasks,
                         std::vector<Method>& methods, int trials, double share) {
  const std::size_t tuning_tasks = std::min<std::size_t>(2, tasks.size());
  std::vector<Cell> cells;
  for (const Method& method : methods) {
    for (const double setting : method.tried) {
      for (std::size_t task = 0; task < tuning_tasks; ++task) {
        Cell cell{.task = task, .method = method, .condition = {}};
        cell.method.setting = setting;
        cells.push_back(std::move(cell));
      }
    }
  }
  const auto results = runner.run(cells, trials, tuning_operators, 0, share);
  std::vector<Tuning> tunings;
  std::size_t at = 0;
  for (Method& method : methods) {
    if (method.tried.empty()) continue;
    Tuning tuning{method.name, {}, 0};
    for (const double setting : method.tried) {
      std::vector<double> costs, times;
      int touched = 0, count = 0;
      for (std::size_t task = 0; task < tuning_tasks; ++task, ++at) {
        for (const TrialResult& result : results[at].trials) {
          costs.push_back(cost_of(result));
          times.push_back(result.time_s);
          touched += result.touched ? 1 : 0;
          ++count;
        }
      }
      tuning.tried.push_back(
          {setting, mean_of(costs).value, share_of(touched, count), mean_of(times)});
      if (tuning.tried.back().cost < tuning.tried[tuning.best].cost) {
        tuning.best = tuning.tried.size() - 1;
      }
    }
    method.setting = tuning.tried[tuning.best].setting;
    tunings.push_back(std::move(tuning));
  }
  return tunings;
}

}  // namespace

const char* to_string(Part part) noexcept {
  switch (part) {
    case Part::tasks:
      return "tasks";
    case Part::delay:
      return "delay";
    case Part::beside:
      return "beside";
    case Part::strict:
      return "strict";
    case Part::devices:
      return "devices";
  }
  return "";
}

void check(const StudyOptions& options) {
  const auto refuse = [](const char* what, const std::string& found, const char* expected) {
    throw Error({.where = "study", .what = what, .found = found, .expected = expected});
  };
  if (options.trials < 1 || options.trials > 100'000 || options.tuning_trials < 1) {
    refuse("that many trials cannot be made", std::to_string(options.trials), "1 to 100000");
  }
  for (const double delay : options.delays_s) {
    if (delay > 0 && delay <= 2) continue;
    refuse("that is no delay", std::to_string(delay) + " s", "more than 0, up to 2 s");
  }
  (void)chosen(options);
}

double cost_of(const TrialResult& result) {
  return result.time_s + (result.touched ? touch_cost_s + speed_cost_s * result.impact_speed : 0);
}

Summary summary_of(const std::vector<TrialResult>& trials) {
  Summary summary;
  summary.trials = static_cast<int>(trials.size());
  int touched = 0, finished = 0;
  std::vector<double> impact, peak;
  const auto mean = [&](double TrialResult::*value) {
    std::vector<double> values;
    for (const TrialResult& trial : trials) values.push_back(trial.*value);
    return mean_of(values);
  };
  for (const TrialResult& trial : trials) {
    touched += trial.touched ? 1 : 0;
    finished += trial.finished ? 1 : 0;
    summary.blew_up += trial.blew_up ? 1 : 0;
    summary.gave += trial.given_j > noticeable_j ? 1 : 0;
    summary.most_given_j = std::max(summary.most_given_j, trial.given_j);
    summary.most_beyond_device_j =
        std::max(summary.most_beyond_device_j, trial.given_beyond_device_j);
    if (!trial.touched) continue;
    impact.push_back(trial.impact_speed);
    peak.push_back(trial.peak_force);
  }
  summary.touched = share_of(touched, summary.trials);
  summary.finished = share_of(finished, summary.trials);
  summary.impact_speed = mean_of(impact);
  summary.peak_force = mean_of(peak);
  summary.overshoot_m = mean(&TrialResult::overshoot_m);
  summary.miss_m = mean(&TrialResult::miss_m);
  summary.time_s = mean(&TrialResult::time_s);
  summary.effort = mean(&TrialResult::effort);
  summary.clearance_m = mean(&TrialResult::clearance_m);
  summary.pushed_j = mean(&TrialResult::pushed_j);
  summary.given_j = mean(&TrialResult::given_j);
  return summary;
}

std::vector<Cell> cells_of(const std::vector<Task>& tasks, const std::vector<Method>& tuned,
                           const StudyOptions& options) {
  // All of the paper's eight at the first two tasks; at the others, one of each coding stands for
  // them.
  const auto stands_for_paper = [](const Method& method) {
    return method.name == "all_I_sustained" || method.name == "all_II_fading";
  };
  const auto is_paper = [](const Method& method) {
    return method.kind == MethodKind::drag && method.direction == DragDirection::all;
  };
  std::vector<Cell> cells;
  for (std::size_t task = 0; task < tasks.size(); ++task) {
    for (const Method& method : tuned) {
      const bool every = task < 2 || !options.methods.empty();
      if (!every && is_paper(method) && !stands_for_paper(method)) continue;
      cells.push_back({Part::tasks, task, method, {}});
    }
  }
  const auto delayed = [](double delay_s, Placement placement) {
    Condition condition;
    condition.delay_s = delay_s;
    condition.placement = placement;
    return condition;
  };
  const auto in_sweep = [&](const Method& method) {
    return !options.methods.empty() || !is_paper(method) || method.name == "all_II_fading";
  };
  for (const Method& method : tuned) {
    if (!in_sweep(method)) continue;
    // Two of ours stand for all four: what differs between them is not the way.
    const bool ours = method.direction == DragDirection::closing;
    if (ours && options.methods.empty() && method.name != "closing" && method.name != "rising") {
      continue;
    }
    for (const double delay_s : options.delays_s) {
      cells.push_back({Part::delay, 0, method, delayed(delay_s, Placement::remote)});
    }
  }
  for (const Method& method : tuned) {
    if (method.name != "rising" && method.name != "potential_field") continue;
    for (const double delay_s : options.delays_s) {
      cells.push_back({Part::beside, 0, method, delayed(delay_s, Placement::local)});
    }
  }
  for (Method method : tuned) {
    if (method.kind != MethodKind::drag || !in_sweep(method)) continue;
    if (method.name != "all_II_fading" && method.name != "rising" && options.methods.empty()) {
      continue;
    }
    method.mode = LimiterMode::strict;
    std::vector<double> delays = options.delays_s;
    delays.insert(delays.begin(), 0.0);
    for (const double delay_s : delays) {
      cells.push_back({Part::strict, 0, method, delayed(delay_s, Placement::remote)});
    }
  }
  for (const Method& method : tuned) {
    if (method.name != "all_II_fading" && method.name != "rising" && method.name != "distance") {
      continue;
    }
    for (const char* name : {"touch", "falcon"}) {
      Condition condition;
      const Device& known = known_device(name);
      condition.device.name = name;
      condition.device.damping_ceiling = known.damping_ceiling;
      condition.device.force_limit = known.force_limit;
      cells.push_back({Part::devices, 0, method, condition});
    }
  }
  return cells;
}

StudyResult run_study(const Workplace& place, const std::vector<Task>& tasks,
                      const StudyOptions& options) {
  constexpr double tuning_share = 0.15;
  check(options);
  std::vector<Method> tuned = chosen(options);
  Runner runner(place, tasks, options);
  StudyResult result;
  result.tunings = tune(runner, tasks, tuned, options.tuning_trials, tuning_share);
  result.cells = runner.run(cells_of(tasks, tuned, options), options.trials, 0, tuning_share, 1);
  result.stopped = runner.stopped();
  return result;
}

}  // namespace vicinity
