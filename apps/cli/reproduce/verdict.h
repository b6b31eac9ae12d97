// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What became of the paper's claims when they were measured.
#pragma once

#include <string>
#include <vector>

namespace vicinity::report {

/// One claim of the paper, held against numbers.
struct Check {
  std::string claim;     ///< a clause, in our words
  std::string measured;  ///< the numbers that decide it
  bool holds = false;
};

struct Verdict {
  bool agrees = false;
  std::string why;  ///< one line
};

/// Agrees where there is a check and all of them hold. `why` gives the first claim with its
/// numbers, or all that do not hold.
Verdict verdict_of(const std::vector<Check>& checks);

}  // namespace vicinity::report
