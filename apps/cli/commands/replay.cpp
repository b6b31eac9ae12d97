// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/replay.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "drag_words.h"
#include "fresh_file.h"
#include "interruption.h"
#include "outputs.h"
#include "picture/canvas.h"
#include "progress_bar.h"
#include "replay/arm.h"
#include "replay/arm_check.h"
#include "replay/joint_log.h"
#include "replay/joint_trajectory.h"
#include "replay/loop.h"
#include "replay/mcap_recording.h"
#include "replay/recording.h"
#include "replay/recording_file.h"
#include "replay/replay_plot.h"
#include "replay/statistics.h"
#include "replay/summary.h"
#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/field_file.h"

namespace vicinity::cli {
namespace {

// Of a tick's record there are some 200 bytes: two gigabytes.
constexpr double most_periods = 1e7;

// Ticks from 0 to the end, both included.
std::uint64_t tick_count(double length_s, double rate) {
  const double periods = std::floor(length_s * rate * (1 + 1e-12));
  if (!(periods < most_periods)) {
    throw Error({.where = "--duration",
                 .what = "these are more ticks than can be recorded",
                 .found = fmt::format("{:.4g} s at {:g} Hz", length_s, rate),
                 .expected = fmt::format("at most {:.0f}", most_periods),
                 .hint = "a lower --rate, or a shorter --duration"});
  }
  return static_cast<std::uint64_t>(periods) + 1;
}

double length_of(const ReplayOptions& options, const JointTrajectory& trajectory) {
  if (!options.duration) return trajectory.length_s();
  if (!(*options.duration > 0)) {
    throw Error({.where = "--duration",
                 .what = "is no time to replay for",
                 .found = fmt::format("{:g} s", *options.duration),
                 .expected = "seconds, more than zero"});
  }
  return *options.duration;
}

// A long run must not end with a file that cannot be written.
void refuse_unwritable(const ReplayOptions& options, double first_s, double last_s) {
  if (is_mcap(options.output)) check_times(first_s, last_s, options.trajectory.string());
  if (!options.plot.empty()) Canvas(options.plot, 1, 1);
  for (const std::filesystem::path& path : {options.output, options.plot}) {
    if (path.empty()) continue;
    const FreshFile trial(path);
  }
}

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

int run(const ReplayOptions& options, const ViscosityField& field, const Arm& arm,
        const JointTrajectory& trajectory, std::ostream& out, std::ostream& err) {
  const double rate = arm.rate;
  const Pace pace{.rate = rate,
                  .ticks = tick_count(length_of(options, trajectory), rate),
                  .real_time = options.real_time};
  const double t_start = trajectory.log().t.front();
  refuse_unwritable(options, t_start, t_start + static_cast<double>(pace.ticks) / rate);
  const WhileWriting to_the_end;  // a signal ends the loop; what there is by then is written
  Recording recording(pace.ticks, arm.robot.coordinates.size());
  Teleoperation teleoperation(arm.robot, arm.points, field, arm.teleoperation);
  LoopReport loop;
  {
    ProgressBar progress(err);
    loop = run_loop(teleoperation, trajectory, arm.X_WB, pace, recording, progress);
  }
  if (recording.ticks().empty()) return 0;  // interrupted before the first tick
  const ReplayOutcome outcome{.field = field,
                              .arm = arm,
                              .points = arm.points.count(),
                              .pace = pace,
                              .t_start = t_start,
                              .recording = recording,
                              .loop = loop,
                              .statistics = statistics_of(recording.ticks())};
  if (!options.output.empty()) {
    write_recording(recording, arm, field, t_start, options.output);
  }
  if (!options.plot.empty()) {
    plot_replay(outcome, options.field, options.trajectory, options.plot);
  }
  if (options.json) {
    out << replay_as_json(outcome).dump(2) << '\n';
  } else {
    out << replay_in_words(outcome, options.output);
  }
  out.flush();
  return 0;
}

}  // namespace

int replay(const ReplayOptions& options, std::ostream& out, std::ostream& err) {
  const ColumnMap columns = column_map_from(options.columns);
  if (options.trajectory.empty() && !options.check_only) {
    throw Error({.what = "no joint log is given", .hint = "--trajectory CSV, or --check-only"});
  }
  std::vector<std::filesystem::path> inputs = files_of(options.arm);
  inputs.insert(inputs.end(), {options.field, options.trajectory});
  check_outputs({{"-o", options.output}, {"--plot", options.plot}}, inputs);
  const ViscosityField field = recoded(open_field(options.field), options.coding);
  Arm arm = read_arm(options.arm);
  std::optional<JointLog> log;
  if (!options.trajectory.empty()) {
    log = read_joint_log(options.trajectory, arm.robot, columns);
    append(arm.remarks, log->remarks);
    const auto& limiter = arm.teleoperation.limiter;
    if (log->qd.size() > 0 && limiter && limiter->mode == LimiterMode::strict) {
      arm.remarks.push_back("strict mode differences positions: recorded velocities are not used");
    }
  }
  append(arm.remarks, oddities_of_place(field, arm, log));
  if (options.check_only) {
    out << (options.json ? check_as_json(field, arm, log).dump(2) + '\n'
                         : check_in_words(field, arm, log));
    return 0;
  }
  return run(options, field, arm, JointTrajectory(std::move(*log)), out, err);
}

}  // namespace vicinity::cli
