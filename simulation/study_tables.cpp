// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <cmath>

#include "simulation/study_report.h"

namespace vicinity {
namespace {

std::string share(const Estimate& e) {
  return fmt::format("{:.0f}\u00a0% ({:.0f}–{:.0f})", 100 * e.value, 100 * e.low, 100 * e.high);
}

std::string ranged(const Estimate& e, double factor, int digits) {
  return fmt::format("{:.{}f}\u00a0±\u00a0{:.{}f}", factor * e.value, digits,
                     factor * (e.high - e.value), digits);
}

// Of those that touched; nothing where none did.
std::string if_touched(const Summary& summary, const Estimate& e, double factor, int digits) {
  return summary.touched.value > 0 ? fmt::format("{:.{}f}", factor * e.value, digits) : "-";
}

std::string joules(double j) {
  return j < 5e-8 ? "0" : j < 1e-4 ? fmt::format("{:.1e}", j) : fmt::format("{:.4f}", j);
}

std::string markdown(const Table& table) {
  std::string text;
  for (std::size_t row = 0; row < table.size(); ++row) {
    text += '|';
    for (const std::string& cell : table[row]) text += ' ' + cell + " |";
    text += '\n';
    if (row > 0) continue;
    text += '|';
    for (std::size_t n = 0; n < table[0].size(); ++n) text += "---|";
    text += '\n';
  }
  return text;
}

nlohmann::ordered_json as_json(const Estimate& e) { return {e.value, e.low, e.high}; }

}  // namespace

Table task_table(const StudyReport& report, std::size_t task) {
  Table table{{"aid", "touched (95 %)", "impact mm/s", "peak N", "overshoot mm", "miss mm",
               "time s", "finished", "effort N·s", "clearance mm", "aid pushed mJ",
               "most given mJ"}};
  for (const CellResult& result : report.study.cells) {
    if (result.cell.part != Part::tasks || result.cell.task != task) continue;
    const Summary& s = result.summary;
    table.push_back({result.cell.method.name, share(s.touched),
                     if_touched(s, s.impact_speed, 1e3, 0), if_touched(s, s.peak_force, 1, 0),
                     ranged(s.overshoot_m, 1e3, 1), ranged(s.miss_m, 1e3, 1),
                     ranged(s.time_s, 1, 2), fmt::format("{:.0f} %", 100 * s.finished.value),
                     ranged(s.effort, 1, 1), ranged(s.clearance_m, 1e3, 1),
                     fmt::format("{:.1f}", 1e3 * s.pushed_j.value),
                     fmt::format("{:.1f}", 1e3 * s.most_given_j)});
  }
  return table;
}

Table delay_table(const StudyReport& report, Part part) {
  Table table{{"aid", "delay ms", "touched (95 %)", "time s", "finished", "overshoot mm",
               "gave beyond taken", "most given J", "most beyond the device's damping J"}};
  for (const CellResult& result : report.study.cells) {
    if (result.cell.part != part) continue;
    const Summary& s = result.summary;
    table.push_back({result.cell.method.name,
                     fmt::format("{:.0f}", 1e3 * result.cell.condition.delay_s), share(s.touched),
                     ranged(s.time_s, 1, 2), fmt::format("{:.0f} %", 100 * s.finished.value),
                     ranged(s.overshoot_m, 1e3, 1), fmt::format("{} of {}", s.gave, s.trials),
                     joules(s.most_given_j), joules(s.most_beyond_device_j)});
  }
  return table;
}

Table device_table(const StudyReport& report) {
  Table table{{"device", "ceiling N·s/m", "aid", "touched (95 %)", "time s", "miss mm"}};
  const auto line = [&](const CellResult& result, const std::string& device, double ceiling) {
    const Summary& s = result.summary;
    table.push_back({device, fmt::format("{:g}", ceiling), result.cell.method.name,
                     share(s.touched), ranged(s.time_s, 1, 2), ranged(s.miss_m, 1e3, 1)});
  };
  for (const CellResult& result : report.study.cells) {
    const Condition& condition = result.cell.condition;
    if (result.cell.part == Part::strict && condition.delay_s == 0) {
      line(result, condition.device.name + ", strict", condition.device.physical_damping[0]);
    }
  }
  for (const CellResult& result : report.study.cells) {
    if (result.cell.part != Part::devices) continue;
    line(result, result.cell.condition.device.name,
         result.cell.condition.device.damping_ceiling[0]);
  }
  for (const CellResult& result : report.study.cells) {
    if (result.cell.part != Part::tasks || result.cell.task != 0) continue;
    for (const char* name : {"none", "all_II_fading", "distance", "rising"}) {
      if (result.cell.method.name == name) {
        line(result, result.cell.condition.device.name,
             result.cell.condition.device.damping_ceiling[0]);
      }
    }
  }
  return table;
}

Table tuning_table(const StudyReport& report) {
  Table table{{"aid", "setting", "tried: cost s (touched)", "taken"}};
  for (const Tuning& tuning : report.study.tunings) {
    std::string tried;
    for (const TunedSetting& each : tuning.tried) {
      tried += fmt::format("{}{:g}: {:.2f} ({:.0f} %)", tried.empty() ? "" : "; ", each.setting,
                           each.cost, 100 * each.touched.value);
    }
    table.push_back({tuning.method, method_named(tuning.method).setting_name, tried,
                     fmt::format("{:g}", tuning.tried[tuning.best].setting)});
  }
  return table;
}

Table operator_table() {
  const OperatorParameters p;
  const auto n = [](double value) { return fmt::format("{:g}", value); };
  const std::string posture =
      "hands in posture, 100-500 N/m, 5-30 N·s/m, 0.7-2 kg: Hogan 1985; Mussa-Ivaldi, Hogan & "
      "Bizzi "
      "1985; Tsuji et al. 1995";
  return {{"what", "value", "source"},
          {"stiffness of hand and arm", n(p.stiffness) + " N/m", posture},
          {"damping", n(p.damping) + " N·s/m", posture},
          {"mass", n(p.mass) + " kg", posture},
          {"reaction to touch", n(p.touch_reaction_s) + " s", "Woodworth & Schlosberg 1954"},
          {"reaction to sight", n(p.sight_reaction_s) + " s", "Woodworth & Schlosberg 1954"},
          {"motion", "minimum jerk", "Flash & Hogan 1985"},
          {"execution noise", n(100 * p.noise) + " % of the speed",
           "signal-dependent: Harris & Wolpert 1998; size as in van Beers, Haggard & Wolpert 2004"},
          {"its correlation", n(p.noise_correlation_s) + " s", "chosen"},
          {"Weber fraction of viscosity",
           n(p.viscosity_weber[0]) + " to " + n(p.viscosity_weber[1]) + ", even over trials",
           "Jones & Hunter 1993 (0.34); Jones, Hunter & Lafontaine 1997 (0.19)"},
          {"a learned viscosity is met", "with " + n(p.viscosity_spread) + " s.d.",
           "what both of them come to"},
          {"a learned force is met", "with " + n(p.force_spread) + " s.d.", "in relation"},
          {"Weber fraction of force",
           n(p.force_weber[0]) + " to " + n(p.force_weber[1]) + ", even over trials",
           "Jones 1989; Pang, Tan & Durlach 1991"},
          {"least force noticed in motion", n(p.least_force) + " N",
           "chosen, of 0.1 to 0.5 N reported"},
          {"own resistance", n(p.own_resistance) + " N·s/m", "chosen"},
          {"depth error", n(1e3 * p.depth_error_m) + " mm s.d.",
           "chosen: the camera is poor or absent"},
          {"error across the line of sight", n(1e3 * p.across_error_m) + " mm s.d.", "chosen"},
          {"seen as there within", n(1e3 * p.tolerance_m) + " mm", "chosen"},
          {"slower at each noticed rise", "by " + n(p.caution) + ", down to " + n(p.least_pace),
           "chosen"},
          {"creeps on until it feels as trained",
           n(1e3 * p.creep_speed) + " mm/s, for " + n(p.creep_most) + " s.d. of the depth error",
           "chosen"},
          {"corrections by sight", fmt::format("{} at most", p.most_corrections), "chosen"},
          {"resistance is felt over", n(1e3 * p.felt_over_s) + " ms", "chosen"},
          {"slowest motion that tells it", n(1e3 * p.slowest_felt) + " mm/s", "chosen"},
          {"reflected contact that stops him", n(p.bump) + " N", "chosen"}};
}

std::string as_markdown(const StudyReport& report) {
  std::string text;
  const auto section = [&](const std::string& title, const Table& table) {
    if (table.size() > 1) text += "## " + title + "\n\n" + markdown(table) + "\n";
  };
  text += "## Claims\n\n| verdict | claim | measured |\n|---|---|---|\n";
  for (const Claim& claim : claims_of(report)) {
    text += fmt::format("| {} | {} | {} |\n",
                        claim.verdict == Claim::Verdict::holds   ? "holds"
                        : claim.verdict == Claim::Verdict::fails ? "**does not hold**"
                                                                 : "not shown",
                        claim.claim, claim.measured);
  }
  text += '\n';
  for (std::size_t task = 0; task < report.tasks.size(); ++task) {
    section(report.tasks[task].name + ": " + report.tasks[task].says, task_table(report, task));
  }
  section("Delay, the aid beside the slave", delay_table(report, Part::delay));
  section("Delay, the aid beside the master", delay_table(report, Part::beside));
  section("Strict", delay_table(report, Part::strict));
  section("Devices", device_table(report));
  section("Tuning", tuning_table(report));
  section("The operator", operator_table());
  return text;
}

nlohmann::ordered_json as_json(const StudyReport& report) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["trials"] = report.options.trials;
  json["seed"] = report.options.seed;
  json["claims"] = Json::array();
  for (const Claim& claim : claims_of(report)) {
    json["claims"].push_back({{"claim", claim.claim},
                              {"verdict", claim.verdict == Claim::Verdict::holds   ? "holds"
                                          : claim.verdict == Claim::Verdict::fails ? "does not hold"
                                                                                   : "not shown"},
                              {"measured", claim.measured}});
  }
  json["settings"] = Json::object();
  for (const Tuning& tuning : report.study.tunings) {
    json["settings"][tuning.method] = tuning.tried[tuning.best].setting;
  }
  json["cells"] = Json::array();
  for (const CellResult& result : report.study.cells) {
    const Summary& s = result.summary;
    const Condition& condition = result.cell.condition;
    json["cells"].push_back({{"part", to_string(result.cell.part)},
                             {"task", report.tasks[result.cell.task].name},
                             {"method", result.cell.method.name},
                             {"mode", to_string(result.cell.method.mode)},
                             {"delay_s", condition.delay_s},
                             {"placement", to_string(condition.placement)},
                             {"device", condition.device.name},
                             {"trials", s.trials},
                             {"touched", as_json(s.touched)},
                             {"finished", as_json(s.finished)},
                             {"impact_speed", as_json(s.impact_speed)},
                             {"peak_force", as_json(s.peak_force)},
                             {"overshoot_m", as_json(s.overshoot_m)},
                             {"miss_m", as_json(s.miss_m)},
                             {"time_s", as_json(s.time_s)},
                             {"effort", as_json(s.effort)},
                             {"clearance_m", as_json(s.clearance_m)},
                             {"pushed_j", as_json(s.pushed_j)},
                             {"most_given_j", s.most_given_j},
                             {"most_beyond_device_j", s.most_beyond_device_j},
                             {"blew_up", s.blew_up}});
  }
  return json;
}

std::string trials_csv(const StudyReport& report) {
  std::string text =
      "part,task,method,delay_ms,placement,device,mode,trial,finished,touched,impact_mm_s,peak_N,"
      "overshoot_mm,miss_mm,time_s,effort_Ns,clearance_mm,pushed_mJ,given_mJ,beyond_device_mJ\n";
  for (const CellResult& result : report.study.cells) {
    const Condition& condition = result.cell.condition;
    const std::string head = fmt::format(
        "{},{},{},{:g},{},{},{}", to_string(result.cell.part), report.tasks[result.cell.task].name,
        result.cell.method.name, 1e3 * condition.delay_s, to_string(condition.placement),
        condition.device.name, to_string(result.cell.method.mode));
    for (std::size_t n = 0; n < result.trials.size(); ++n) {
      const TrialResult& t = result.trials[n];
      text += fmt::format(
          "{},{},{:d},{:d},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n",
          head, n, t.finished, t.touched, 1e3 * t.impact_speed, t.peak_force, 1e3 * t.overshoot_m,
          1e3 * t.miss_m, t.time_s, t.effort, 1e3 * t.clearance_m, 1e3 * t.pushed_j,
          1e3 * t.given_j, 1e3 * t.given_beyond_device_j);
    }
  }
  return text;
}

}  // namespace vicinity
