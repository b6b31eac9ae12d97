// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/verdict.h"

#include <algorithm>

namespace vicinity::report {

Verdict verdict_of(const std::vector<Check>& checks) {
  if (checks.empty()) return {false, "nothing was measured"};
  const auto all = checks.size();
  const auto fail = static_cast<std::size_t>(
      std::ranges::count_if(checks, [](const Check& check) { return !check.holds; }));
  const auto with_numbers = [](const Check& c) { return c.claim + " (" + c.measured + ")"; };
  if (fail == 0) {
    return {true, "all " + std::to_string(all) + " checks hold, first: " + with_numbers(checks[0])};
  }
  std::string why = std::to_string(fail) + " of " + std::to_string(all) + " checks do not hold";
  for (const Check& check : checks) {
    if (!check.holds) why += "; not so: " + with_numbers(check);
  }
  return {false, why};
}

}  // namespace vicinity::report
