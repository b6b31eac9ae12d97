// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulate/study_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "page.h"
#include "picture/chart.h"
#include "readable.h"
#include "simulate/interval_picture.h"

namespace vicinity::cli {
namespace {

const CellResult* cell_of(const StudyReport& report, std::size_t task, const std::string& method) {
  for (const CellResult& result : report.study.cells) {
    if (result.cell.part == Part::tasks && result.cell.task == task &&
        result.cell.method.name == method) {
      return &result;
    }
  }
  return nullptr;
}

PagePicture intervals(const StudyReport& report, const std::filesystem::path& file,
                      Estimate Summary::*what, double factor, const std::string& unit,
                      const std::string& title, const std::string& says) {
  std::vector<std::string> names;
  for (const CellResult& result : report.study.cells) {
    const std::string& name = result.cell.method.name;
    const bool known = std::find(names.begin(), names.end(), name) != names.end();
    if (result.cell.part == Part::tasks && !known) names.push_back(name);
  }
  std::vector<IntervalColumn> columns;
  for (std::size_t task = 0; task < report.tasks.size(); ++task) {
    IntervalColumn column{report.tasks[task].name, 0, {}, {}};
    for (const std::string& name : names) {
      const CellResult* const cell = cell_of(report, task, name);
      Estimate e = cell ? cell->summary.*what : Estimate{};
      e = {factor * e.value, factor * e.low, factor * e.high};
      column.most = std::max(column.most, e.high);
      column.rows.push_back(e);
      // Speeds of touches are there where there were some.
      column.there.push_back(cell && (what != &Summary::impact_speed || e.value > 0));
    }
    const double decade = std::pow(10, std::floor(std::log10(std::max(column.most, 1e-9))));
    column.most = std::ceil(column.most / decade * 2) / 2 * decade;
    columns.push_back(std::move(column));
  }
  draw_intervals(names, columns, file);
  return {file, title + " [" + unit + "]", says};
}

// One line an aid, over delay; the value without delay from the table of tasks.
template <class Value>
ChartPanel over_delay(const StudyReport& report, Part part, const std::string& label,
                      const Value& value) {
  std::map<std::string, Series> by_method;
  std::vector<std::string> order;
  for (const CellResult& result : report.study.cells) {
    if (result.cell.part != part) continue;
    const std::string& name = result.cell.method.name;
    if (!by_method.contains(name)) {
      order.push_back(name);
      by_method[name].name = name;
      const CellResult* const still = cell_of(report, 0, name);
      if (part != Part::strict && still) {
        by_method[name].points.emplace_back(0, value(still->summary));
      }
    }
    by_method[name].points.emplace_back(1e3 * result.cell.condition.delay_s, value(result.summary));
  }
  ChartPanel panel{label, {}, false};
  for (const std::string& name : order) panel.series.push_back(by_method[name]);
  return panel;
}

bool has(const StudyReport& report, Part part) {
  return std::any_of(report.study.cells.begin(), report.study.cells.end(),
                     [&](const CellResult& result) { return result.cell.part == part; });
}

PagePicture delay_chart(const StudyReport& report, Part part, const std::filesystem::path& file,
                        const std::string& title, const std::string& says) {
  Chart chart;
  chart.x_label = "delay, there and back [ms]";
  chart.panels.push_back(over_delay(report, part, "touched [%]",
                                    [](const Summary& s) { return 100 * s.touched.value; }));
  chart.panels.push_back(over_delay(report, part, "most given to the hand [mJ]",
                                    [](const Summary& s) { return 1e3 * s.most_given_j; }));
  chart.panels.push_back(over_delay(report, part, "beyond the device's damping [mJ]",
                                    [](const Summary& s) { return 1e3 * s.most_beyond_device_j; }));
  draw_chart(chart, file);
  return {file, title, says};
}

PageSection claims(const StudyReport& report) {
  PageSection section{.title = "What holds",
                      .says =
                          "Computed from the cells below. A claim holds, or does not, where the 95 "
                          "% ranges of both "
                          "sides do not meet; else it is not shown."};
  for (const Claim& claim : claims_of(report)) {
    using Tone = PageNote::Tone;
    const bool open = claim.verdict == Claim::Verdict::open;
    const bool holds = claim.verdict == Claim::Verdict::holds;
    section.notes.push_back({open    ? "Not shown"
                             : holds ? "Holds"
                                     : "Does not hold",
                             claim.claim + ": " + claim.measured + ".",
                             open    ? Tone::plain
                             : holds ? Tone::good
                                     : Tone::bad});
  }
  return section;
}

PageSection overview(const StudyReport& report, const std::filesystem::path& folder) {
  PageSection section{.title = "All aids at all tasks",
                      .says =
                          "No delay. Squares are shares or "
                          "means, whiskers their 95 % ranges."};
  section.pictures.push_back(intervals(report, folder / "touched.svg", &Summary::touched, 100, "%",
                                       "Trials that touched",
                                       "Any contact of the arm with the workplace, by MuJoCo."));
  section.pictures.push_back(intervals(report, folder / "impact.svg", &Summary::impact_speed, 1e3,
                                       "mm/s", "Speed of the first touch",
                                       "Along its normal, of the trials that touched."));
  section.pictures.push_back(intervals(report, folder / "time.svg", &Summary::time_s, 1, "s",
                                       "Time to finish",
                                       "Until the operator believed to be there."));
  section.pictures.push_back(intervals(report, folder / "effort.svg", &Summary::effort, 1, "N·s",
                                       "Effort of the hand", "Force over time."));
  section.pictures.push_back(intervals(report, folder / "clearance.svg", &Summary::clearance_m, 1e3,
                                       "mm", "Smallest clearance",
                                       "Of any body point of the slave, in the mean."));
  return section;
}

}  // namespace

void write_study_page(const StudyReport& report, const std::filesystem::path& folder) {
  Page page{
      .title = "Does the operator really do better?",
      .says = fmt::format(
          "{}. {} trials in each cell, seed {}; {} cells, made in {}. Operators are simulated, "
          "and the numbers hold for them: the table at the end says where each of theirs is "
          "from. The same seeded hands meet every aid.",
          report.place, report.options.trials, report.options.seed, report.study.cells.size(),
          seconds(report.seconds))};
  page.sections.push_back(claims(report));
  page.sections.push_back(overview(report, folder));
  for (std::size_t task = 0; task < report.tasks.size(); ++task) {
    PageSection section{.title = report.tasks[task].name, .says = report.tasks[task].says + "."};
    section.table = task_table(report, task);
    page.sections.push_back(std::move(section));
  }
  if (has(report, Part::delay)) {
    PageSection section{.title = "Delay: where each aid breaks",
                        .says = "Task " + report.tasks[0].name +
                                ". The aid is computed beside the slave, so that its force comes "
                                "back a round trip late."};
    section.pictures.push_back(delay_chart(report, Part::delay, folder / "delay.svg", "Over delay",
                                           "All drags in device mode."));
    section.table = delay_table(report, Part::delay);
    page.sections.push_back(std::move(section));
  }
  if (has(report, Part::beside)) {
    page.sections.push_back({.title = "Delay, with the aid beside the master",
                             .says = "Computed from what the master leads to: no delay between "
                                     "motion and force."});
    page.sections.back().table = delay_table(report, Part::beside);
  }
  if (has(report, Part::strict)) {
    PageSection section{.title = "Strict: within the device's own damping",
                        .says =
                            "Beside the slave again. What the aid gave beyond what the device's "
                            "own damping had eaten must be zero."};
    section.table = delay_table(report, Part::strict);
    page.sections.push_back(std::move(section));
  }
  if (const Table devices = device_table(report); devices.size() > 1) {
    page.sections.push_back({.title = "Devices",
                             .says = "Task " + report.tasks[0].name +
                                     ", no delay. What a device bears decides how much is felt."});
    page.sections.back().table = devices;
  }
  if (!report.study.tunings.empty()) {
    page.sections.push_back(
        {.title = "Tuning",
         .says = fmt::format(
             "Each aid has one setting. Five values of it were tried on the first two tasks, {} "
             "trials each, with operators who do not come again; taken is the one of least cost: "
             "seconds to finish, two more for a touch and one for each 10 mm/s of its speed. The "
             "operator is trained once with each "
             "aid "
             "and task: a slow and perfect approach.",
             report.options.tuning_trials)});
    page.sections.back().table = tuning_table(report);
  }
  page.sections.push_back({.title = "The operator", .says = ""});
  page.sections.back().table = operator_table();
  PageSection again{.title = "Again, and by hand",
                    .says =
                        "The first trial of every aid at every "
                        "task is recorded as a joint log; replay sends it through the tick again."};
  again.commands = {report.command, report.replay};
  again.links = {"study.json", "trials.csv", "tables.md"};
  again.links.insert(again.links.end(), report.recordings.begin(), report.recordings.end());
  page.sections.push_back(std::move(again));
  write_page(page, folder / "index.html");
}

}  // namespace vicinity::cli
