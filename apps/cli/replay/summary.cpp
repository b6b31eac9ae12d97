// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "readable.h"
#include "replay/report.h"

namespace vicinity::cli {
namespace {

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

std::string reason_in_words(const ReplayOutcome& outcome, const Reason& reason) {
  if (reason.link < 0) return "";
  const std::string& link = outcome.arm.robot.links[static_cast<std::size_t>(reason.link)].name;
  if (reason.object < 0) return fmt::format(", by {}, which still remembers", link);
  const std::string& object = outcome.field.objects()[static_cast<std::size_t>(reason.object)].name;
  if (reason.kind == VoxelKind::boundary || reason.kind == VoxelKind::inner) {
    return fmt::format(", by {} in the {} of {}", link,
                       reason.kind == VoxelKind::boundary ? "skin" : "inside", object);
  }
  return fmt::format(", by {} in rank {} of {}, at least {:.3g} mm away", link, reason.rank, object,
                     1000 * reason.distance_m);
}

void report_felt(const ReplayOutcome& outcome, Report& report) {
  const ReplayStatistics& statistics = outcome.statistics;
  const auto ticks = static_cast<double>(outcome.recording.ticks().size());
  if (!statistics.strongest) {
    report.line("felt", "nothing, in any tick");
    return;
  }
  const TickRecord& tick = outcome.recording.ticks()[*statistics.strongest];
  report.line("felt",
              "in {:.1f} % of the ticks, by {:.1f} % of the points in the mean, {:.1f} % at most",
              percent(static_cast<double>(statistics.felt), ticks),
              percent(statistics.mean_points_felt, static_cast<double>(outcome.points)),
              percent(statistics.most_points_felt, static_cast<double>(outcome.points)));
  report.line("most", "{:.4g} N at t = {:.3f} s{}", tick.tool.force.norm(),
              outcome.t_start + tick.time_s, reason_in_words(outcome, tick.reason));
}

void report_statuses(const ReplayOutcome& outcome, Report& report) {
  std::string words;
  for (const auto& [status, count] : outcome.statistics.statuses) {
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", to_string(status), grouped(count));
  }
  report.line("statuses", "{}", words);
}

void report_limiter(const ReplayOutcome& outcome, Report& report) {
  std::string words = outcome.arm.limiter;
  if (outcome.arm.teleoperation.limiter) {
    words += "; ";
    if (outcome.statistics.limits.empty()) words += "it had nothing to hold down";
    bool first = true;
    for (const auto& [limit, count] : outcome.statistics.limits) {
      words += fmt::format("{}held down for {} in {:.1f} % of the ticks", first ? "" : ", ",
                           to_string(limit),
                           percent(static_cast<double>(count),
                                   static_cast<double>(outcome.recording.ticks().size())));
      first = false;
    }
    words +=
        fmt::format("; at the least {:.3g} of the drag was given", outcome.statistics.lowest_scale);
  }
  report.line("limiter", "{}", words);
}

void report_energy(const ReplayOutcome& outcome, Report& report) {
  const EnergyBalance& energy = outcome.recording.energy();
  const auto& limiter = outcome.arm.teleoperation.limiter;
  std::string words = "passive: never more had come out than gone in";
  if (!energy.passive) {
    const bool promised = limiter && limiter->mode == LimiterMode::strict;
    words = fmt::format("at its worst {:.3g} J more had come out than gone in{}", -energy.lowest,
                        promised ? "" : "; only strict mode promises that none does");
  }
  if (energy.unaccounted > 0) {
    words += fmt::format("; {} periods could not be accounted", grouped(energy.unaccounted));
  }
  report.line("energy", "the drag took {:.4g} J out of the motion; {}", energy.drag, words);
}

void report_times(const ReplayOutcome& outcome, Report& report) {
  const TimeHistogram& times = outcome.statistics.times;
  report.line("tick", "p50 {:.1f} µs, p99 {:.1f}, p99.9 {:.1f}, longest {:.1f}", times.p50_us,
              times.p99_us, times.p999_us, times.max_us);
  std::uint64_t most = 1;
  for (const TimeHistogram::Bin& bin : times.bins) most = std::max(most, bin.ticks);
  constexpr double width = 40;
  for (const TimeHistogram::Bin& bin : times.bins) {
    const double share = static_cast<double>(bin.ticks) / static_cast<double>(most);
    std::string bar;
    for (int n = 0; n < static_cast<int>(share * width + 0.5); ++n) bar += "█";
    if (bar.empty() && bin.ticks > 0) bar = "▏";
    report.line("", "{:>6g} to {:<6g} µs {:>12} {}", bin.from_us, bin.to_us, grouped(bin.ticks),
                bar);
  }
}

void report_real_time(const ReplayOutcome& outcome, Report& report) {
  if (!outcome.pace.real_time) return;
  for (const std::string& words : outcome.loop.granted) report.line("real time", "{}", words);
  double latest = 0;
  for (const TickRecord& tick : outcome.recording.ticks()) {
    latest = std::max(latest, static_cast<double>(tick.late_us));
  }
  const Misses& misses = outcome.statistics.misses;
  const std::uint64_t missed = misses.late_wake_ups + misses.long_ticks;
  report.line(
      "deadlines",
      "{} missed (more than {:.3g} ms after the tick before), {} skipped; latest wake-up {:.0f} µs",
      grouped(missed), 1000 * outcome.arm.teleoperation.longest_period_s,
      grouped(outcome.loop.skipped), latest);
  if (missed > 0) {
    report.line("",
                "{} because the wake-up came late (worst {:.0f} µs), {} because the tick before "
                "took long (worst {:.0f} µs)",
                grouped(misses.late_wake_ups), misses.worst_wake_us, grouped(misses.long_ticks),
                misses.worst_tick_us);
  }
}

void report_process(const ReplayOutcome& outcome, Report& report) {
  const ProcessUse &before = outcome.loop.before, &after = outcome.loop.after;
  report.line("memory", "{} resident at the start, {} at the end; {} page faults on the way",
              bytes(before.resident_bytes), bytes(after.resident_bytes),
              grouped(after.page_faults - before.page_faults));
  if (outcome.pace.real_time) {
    report.line("", "put aside for another thread {} times",
                grouped(after.preemptions - before.preemptions));
  }
}

}  // namespace

std::string replay_in_words(const ReplayOutcome& outcome, const std::filesystem::path& output) {
  const auto ticks = outcome.recording.ticks();
  Report report;
  report.line("replayed", "{} ticks at {:g} Hz, {:.3f} s of motion in {}{}", grouped(ticks.size()),
              outcome.pace.rate, ticks.back().time_s, seconds(outcome.loop.seconds),
              outcome.loop.interrupted ? ", when it was interrupted" : "");
  report.line("arm", "{}: {} joints, {} points", outcome.arm.robot.name, outcome.recording.joints(),
              grouped(outcome.points));
  report_felt(outcome, report);
  report_statuses(outcome, report);
  report_limiter(outcome, report);
  report_energy(outcome, report);
  report_times(outcome, report);
  report_real_time(outcome, report);
  report_process(outcome, report);
  for (const std::string& remark : outcome.arm.remarks) report.line("odd", "{}", remark);
  if (!output.empty()) report.line("written", "{}", output.string());
  return std::move(report).text();
}

nlohmann::ordered_json replay_as_json(const ReplayOutcome& outcome) {
  using Json = nlohmann::ordered_json;
  const ReplayStatistics& statistics = outcome.statistics;
  const auto ticks = outcome.recording.ticks();
  const auto count = static_cast<double>(ticks.size());
  const auto points = static_cast<double>(outcome.points);
  Json json{{"ticks", ticks.size()},
            {"rate", outcome.pace.rate},
            {"seconds", ticks.back().time_s},
            {"joints", outcome.recording.joints()},
            {"points", outcome.points}};
  json["statuses"] = Json::object();
  for (const auto& [status, n] : statistics.statuses) json["statuses"][to_string(status)] = n;
  json["felt_share"] = static_cast<double>(statistics.felt) / count;
  json["points_felt"] = {{"mean_share", statistics.mean_points_felt / points},
                         {"most_share", statistics.most_points_felt / points}};
  json["strongest"] = nullptr;
  if (statistics.strongest) {
    const TickRecord& tick = ticks[*statistics.strongest];
    const Reason& reason = tick.reason;
    Json strongest{{"t", outcome.t_start + tick.time_s}, {"force", tick.tool.force.norm()}};
    const bool known = reason.object >= 0;
    strongest["link"] =
        reason.link < 0 ? Json()
                        : Json(outcome.arm.robot.links[static_cast<std::size_t>(reason.link)].name);
    strongest["object"] =
        known ? Json(outcome.field.objects()[static_cast<std::size_t>(reason.object)].name)
              : Json();
    strongest["rank"] = known ? Json(reason.rank) : Json();
    strongest["distance_mm"] = known ? Json(1000 * reason.distance_m) : Json();
    json["strongest"] = strongest;
  }
  json["limiter"] = {{"words", outcome.arm.limiter},
                     {"limits", Json::object()},
                     {"lowest_scale", statistics.lowest_scale}};
  for (const auto& [limit, n] : statistics.limits) json["limiter"]["limits"][to_string(limit)] = n;
  const EnergyBalance& energy = outcome.recording.energy();
  json["energy"] = {{"drag", energy.drag},       {"device", energy.device},
                    {"lowest", energy.lowest},   {"passive", energy.passive},
                    {"records", energy.records}, {"unaccounted", energy.unaccounted}};
  const TimeHistogram& times = statistics.times;
  json["tick_us"] = {{"p50", times.p50_us},
                     {"p99", times.p99_us},
                     {"p999", times.p999_us},
                     {"max", times.max_us},
                     {"bins", Json::array()}};
  for (const TimeHistogram::Bin& bin : times.bins) {
    json["tick_us"]["bins"].push_back(
        {{"from", bin.from_us}, {"to", bin.to_us}, {"ticks", bin.ticks}});
  }
  json["real_time"] = nullptr;
  if (outcome.pace.real_time) {
    json["real_time"] = {{"granted", outcome.loop.granted},
                         {"late_wake_ups", statistics.misses.late_wake_ups},
                         {"long_ticks", statistics.misses.long_ticks},
                         {"skipped", outcome.loop.skipped},
                         {"worst_wake_us", statistics.misses.worst_wake_us},
                         {"worst_tick_us", statistics.misses.worst_tick_us}};
  }
  json["resident_bytes"] = {{"start", outcome.loop.before.resident_bytes},
                            {"end", outcome.loop.after.resident_bytes}};
  json["loop_seconds"] = outcome.loop.seconds;
  json["interrupted"] = outcome.loop.interrupted;
  json["remarks"] = outcome.arm.remarks;
  return json;
}

}  // namespace vicinity::cli
