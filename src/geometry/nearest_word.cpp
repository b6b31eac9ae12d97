// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/geometry/nearest_word.h"

#include <algorithm>
#include <cstddef>

namespace vicinity {
namespace {

// Optimal string alignment distance, three rows at a time.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before = above;
    above = row;
  }
  return above[b.size()];
}

}  // namespace

std::string nearest_word(std::string_view typed, const std::vector<std::string>& known) {
  std::string nearest;
  // Half the letters wrong is no longer a slip of the finger.
  std::size_t fewest = std::max<std::size_t>(2, typed.size() / 2) + 1;
  for (const std::string& word : known) {
    const std::size_t n = word.starts_with(typed) && !typed.empty() ? 1 : edits(typed, word);
    if (n < fewest) {
      fewest = n;
      nearest = word;
    }
  }
  return nearest;
}

}  // namespace vicinity
