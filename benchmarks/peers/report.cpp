// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "peers/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "vicinity/geometry/error.h"

namespace vicinity::peers {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw Error({.where = path.string(), .what = "cannot be written"});
}

}  // namespace

bool Report::Target::met() const {
  if (!measured) return false;
  return sense == Sense::at_least ? *measured >= goal : *measured <= goal;
}

void Report::timings(const std::string& group, const std::string& subject,
                     const std::vector<Timing>& timings, double items) {
  for (const Timing& t : timings) {
    line(group, "subject,way,wall_s,cpu_s,wall_ns_each,runs",
         fmt::format("\"{}\",\"{}\",{:.6g},{:.6g},{},{}", subject, t.name, t.wall, t.cpu,
                     items > 0 ? fmt::format("{:.4g}", 1e9 * t.wall / items) : "", t.runs));
  }
}

void Report::line(const std::string& group, const std::string& header, const std::string& line) {
  auto found =
      std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) { return g.name == group; });
  if (found == groups_.end()) {
    groups_.push_back({group, header + "\n"});
    found = groups_.end() - 1;
  }
  found->csv += line + "\n";
}

Report::Target& Report::target_named(const std::string& name, Sense sense, double goal) {
  for (Target& target : targets_) {
    if (target.name == name) return target;
  }
  return targets_.emplace_back(Target{name, sense, goal, {}, {}});
}

void Report::target(const std::string& name, Sense sense, double goal, double measured,
                    const std::string& on) {
  Target& target = target_named(name, sense, goal);
  const bool worse = !target.measured || (sense == Sense::at_least ? measured < *target.measured
                                                                   : measured > *target.measured);
  if (!worse) return;
  target.measured = measured;
  target.on = on;
}

void Report::not_measured(const std::string& name, Sense sense, double goal,
                          const std::string& why) {
  target_named(name, sense, goal).on = why;
}

void Report::print() const {
  fmt::print("\n{:<62} {:>10} {:>12}  {:<12} {}\n", "target", "measured", "goal", "", "worst on");
  for (const Target& t : targets_) {
    fmt::print("{:<62} {:>10} {:>2} {:>9.4g}  {:<12} {}\n", t.name,
               t.measured ? fmt::format("{:.3g}", *t.measured) : "-",
               t.sense == Sense::at_least ? ">=" : "<=", t.goal,
               !t.measured ? "not measured"
               : t.met()   ? "met"
                           : "MISSED",
               t.on);
  }
}

void Report::save(const std::filesystem::path& folder) const {
  std::filesystem::create_directories(folder);
  nlohmann::ordered_json json = nlohmann::json::array();
  for (const Target& t : targets_) {
    nlohmann::ordered_json row = {{"name", t.name},
                                  {"measured", nullptr},
                                  {"target", t.goal},
                                  {"met", t.met()},
                                  {"sense", t.sense == Sense::at_least ? ">=" : "<="},
                                  {t.measured ? "on" : "not_measured", t.on}};
    if (t.measured) row["measured"] = *t.measured;
    json.push_back(std::move(row));
  }
  write(folder / "bench.json", json.dump(2) + "\n");
  for (const Group& group : groups_) write(folder / (group.name + ".csv"), group.csv);
}

}  // namespace vicinity::peers
