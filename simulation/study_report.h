// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a study says, as tables and verdicts.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulation/study.h"

namespace vicinity {

using Table = std::vector<std::vector<std::string>>;  // first row: headings

/// All that the report is made from.
struct StudyReport {
  const StudyResult& study;
  const std::vector<Task>& tasks;
  const StudyOptions& options;
  std::string place = {};                    ///< scene and arm, in words
  std::string command = {};                  ///< that makes it again
  double seconds = 0;                        ///< that the whole took
  std::vector<std::string> recordings = {};  ///< files, relative to the folder
  std::string replay = {};                   ///< a command that plays one of them
};

/// A claim of the paper's, or of ours, and what the numbers say. Where ranges overlap nothing is
/// claimed.
struct Claim {
  enum class Verdict { holds, fails, open } verdict = Verdict::open;
  std::string claim, measured;
};

/// Computed from the cells that are there; claims about cells that are not are left out.
std::vector<Claim> claims_of(const StudyReport& report);

/// One line a method: how often it touched, how hard, how long, how much was felt.
Table task_table(const StudyReport& report, std::size_t task);
/// One line a method and delay.
Table delay_table(const StudyReport& report, Part part);
Table device_table(const StudyReport& report);
Table tuning_table(const StudyReport& report);
/// Every number of the operator with its source.
Table operator_table();

/// The same as Markdown, for a document.
std::string as_markdown(const StudyReport& report);
nlohmann::ordered_json as_json(const StudyReport& report);
std::string trials_csv(const StudyReport& report);

}  // namespace vicinity
