// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What was measured, and which targets that meets: a table to read, bench.json, and CSVs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "peers/side_by_side.h"

namespace vicinity::peers {

class Report {
 public:
  enum class Sense { at_least, at_most };

  /// Timings of one comparison: lines of GROUP.csv.
  /// @param items  what a timing is divided by to give nanoseconds each; 0: given as seconds only
  void timings(const std::string& group, const std::string& subject,
               const std::vector<Timing>& timings, double items = 0);

  /// Another line of GROUP.csv, whose first line is `header`.
  void line(const std::string& group, const std::string& header, const std::string& line);

  /// One more measurement of a target. Where several are made (on several objects), the worst
  /// counts, and the table says on which.
  void target(const std::string& name, Sense sense, double goal, double measured,
              const std::string& on);
  /// A target that this run says nothing about.
  void not_measured(const std::string& name, Sense sense, double goal, const std::string& why);

  void print() const;
  /// Writes bench.json and the CSVs. Errors: throws Error for a folder that cannot be written.
  void save(const std::filesystem::path& folder) const;

 private:
  struct Target {
    std::string name;
    Sense sense;
    double goal;
    std::optional<double> measured;
    std::string on;

    bool met() const;
  };
  struct Group {
    std::string name, csv;
  };

  Target& target_named(const std::string& name, Sense sense, double goal);

  std::vector<Target> targets_;
  std::vector<Group> groups_;
};

}  // namespace vicinity::peers
