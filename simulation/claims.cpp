// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>

#include "simulation/study_report.h"

namespace vicinity {
namespace {

using Verdict = Claim::Verdict;

constexpr double few_touches = 5;

class Judge {
 public:
  explicit Judge(const StudyReport& report) : report_(report) {}

  const Summary* at(const std::string& task, const std::string& method) const {
    for (const CellResult& result : report_.study.cells) {
      if (result.cell.part == Part::tasks && report_.tasks[result.cell.task].name == task &&
          result.cell.method.name == method) {
        return &result.summary;
      }
    }
    return nullptr;
  }

  // A claim that one number is below another.
  void lower(std::vector<Claim>& claims, const std::string& claim, const std::string& task,
             const std::string& a, const std::string& b, Estimate Summary::*what, double factor,
             const char* unit) const {
    const Summary* const first = at(task, a);
    const Summary* const second = at(task, b);
    if (first == nullptr || second == nullptr) return;
    const Estimate &x = first->*what, &y = second->*what;
    // Speeds of touches are means of those that touched: of a few of them nothing is claimed.
    const bool few = what == &Summary::impact_speed &&
                     std::min(first->touched.value * first->trials,
                              second->touched.value * second->trials) < few_touches;
    claims.push_back(
        {few           ? Verdict::open
         : below(x, y) ? Verdict::holds
         : below(y, x) ? Verdict::fails
                       : Verdict::open,
         claim,
         fmt::format("{}: {} {:.3g} ({:.3g} to {:.3g}) {}, {} {:.3g} ({:.3g} to {:.3g}) {}", task,
                     a, factor * x.value, factor * x.low, factor * x.high, unit, b,
                     factor * y.value, factor * y.low, factor * y.high, unit)});
  }

  const StudyReport& report_;
};

// At which delays an aid gave more than it had taken, in any trial.
std::string where_it_gave(const StudyReport& report, Part part, const std::string& method,
                          bool beyond_device, double& most) {
  std::string where;
  most = 0;
  for (const CellResult& result : report.study.cells) {
    if (result.cell.part != part || result.cell.method.name != method) continue;
    const double given =
        beyond_device ? result.summary.most_beyond_device_j : result.summary.most_given_j;
    most = std::max(most, given);
    if (given < 1e-6) continue;
    where += fmt::format("{}{:.0f} ms: {:.2g} J", where.empty() ? "" : ", ",
                         1e3 * result.cell.condition.delay_s, given);
  }
  return where;
}

}  // namespace

std::vector<Claim> claims_of(const StudyReport& report) {
  const Judge judge(report);
  std::vector<Claim> claims;
  const auto touched = &Summary::touched;
  const auto impact = &Summary::impact_speed;
  judge.lower(claims, "Paper: with drag one arrives slowly, so that a touch is no impact",
              "approach", "all_II_fading", "none", impact, 1e3, "mm/s");
  judge.lower(claims, "The same with ours", "approach", "rising", "none", impact, 1e3, "mm/s");
  judge.lower(claims, "The same between two parts", "pass", "all_II_fading", "none", impact, 1e3,
              "mm/s");
  judge.lower(claims, "The same between two parts, with ours", "pass", "rising", "none", impact,
              1e3, "mm/s");
  judge.lower(claims, "Paper: drag lets the operator perceive nearness, so that he touches less",
              "approach", "all_II_fading", "none", touched, 100, "% touched");
  judge.lower(claims, "The same with ours", "approach", "rising", "none", touched, 100,
              "% touched");
  judge.lower(claims, "The same, passing between two parts", "pass", "all_II_fading", "none",
              touched, 100, "% touched");
  judge.lower(claims, "The same, passing between two parts, with ours", "pass", "rising", "none",
              touched, 100, "% touched");
  judge.lower(claims, "Ours touches less than the paper's drag", "approach", "rising",
              "all_II_fading", touched, 100, "% touched");
  judge.lower(claims, "Paper: a force field keeps one from reaching a part; drag does not",
              "insert", "potential_field", "all_II_fading", &Summary::finished, 100, "% finished");
  judge.lower(claims, "Paper: nonlinear coding takes less effort than linear", "approach",
              "all_II_sustained", "all_I_sustained", &Summary::effort, 1, "N·s");
  judge.lower(claims, "Table 2: no memory (I) touches less than long memory (II), which comes late",
              "approach", "all_II_none", "all_II_sustained", touched, 100, "% touched");
  judge.lower(claims, "Ours: retreat is free, where the paper's drag holds one back", "retreat",
              "rising", "all_II_fading", &Summary::effort, 1, "N·s");
  judge.lower(claims, "Ours: the way along a part is faster than with the paper's drag", "follow",
              "rising", "all_II_fading", &Summary::time_s, 1, "s");
  judge.lower(claims, "Drag touches less than speed scaling", "approach", "rising", "speed_scaling",
              touched, 100, "% touched");
  judge.lower(claims, "Drag touches less than a virtual fixture", "approach", "rising",
              "virtual_fixture", touched, 100, "% touched");
  judge.lower(claims, "Drag costs less effort than a force field between parts", "pass", "rising",
              "potential_field", &Summary::effort, 1, "N·s");

  for (const char* method : {"potential_field", "virtual_fixture"}) {
    double most = 0;
    const std::string where = where_it_gave(report, Part::delay, method, true, most);
    if (judge.at(report.tasks[0].name, method) == nullptr) continue;
    claims.push_back({where.empty() ? Verdict::fails : Verdict::holds,
                      fmt::format("Paper: a force field ({}) puts energy into the hand", method),
                      where.empty() ? "beyond what the device's damping eats: at no delay tried"
                                    : "beyond what the device's damping eats, at " + where});
  }
  double most = 0;
  for (const char* method : {"all_II_fading", "rising"}) {
    if (judge.at(report.tasks[0].name, method) == nullptr) continue;
    const std::string where = where_it_gave(report, Part::delay, method, true, most);
    claims.push_back(
        {where.empty() ? Verdict::holds : Verdict::fails,
         fmt::format("Paper: drag ({}) is stable, in device mode, beside the slave, at any delay",
                     method),
         where.empty() ? "it never gave beyond what the device's damping eats"
                       : "beyond what the device's damping eats, at " + where});
  }
  most = 0;
  bool strict_there = false;
  for (const CellResult& result : report.study.cells) {
    if (result.cell.part != Part::strict) continue;
    strict_there = true;
    most = std::max(most, result.summary.most_beyond_device_j);
  }
  if (strict_there) {
    claims.push_back(
        {most < 1e-6 ? Verdict::holds : Verdict::fails,
         "Strict: no drag puts energy into the hand, at any delay",
         fmt::format("most in any trial, beyond the device's own damping: {:.2g} J", most)});
  }
  most = 0;
  for (const CellResult& result : report.study.cells) {
    if (result.cell.method.kind == MethodKind::drag && result.cell.part == Part::tasks) {
      most = std::max(most, result.summary.most_given_j);
    }
  }
  if (most > 0 || judge.at(report.tasks[0].name, "rising")) {
    claims.push_back({most < 1e-3 ? Verdict::holds : Verdict::fails,
                      "Paper: drag never pushes, so that it stays stable (device mode, no delay)",
                      fmt::format("most in any trial: {:.2g} J", most)});
  }
  return claims;
}

}  // namespace vicinity
