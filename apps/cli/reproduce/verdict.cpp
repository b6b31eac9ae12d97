// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/verdict.h"

#include <algorithm>

namespace vicinity::report {

Verdict verdict_of(const std::vector<Check>& checks) {
  Verdict verdict;
  verdict.agrees =
      !checks.empty() && std::ranges::all_of(checks, [](const Check& c) { return c.holds; });
  for (const Check& check : checks) {
    if (check.holds != verdict.agrees) continue;
    if (!verdict.why.empty()) verdict.why += "; ";
    verdict.why += (check.holds ? "" : "not so: ") + check.claim + " (" + check.measured + ")";
  }
  if (checks.empty()) verdict.why = "nothing was measured";
  return verdict;
}

}  // namespace vicinity::report
