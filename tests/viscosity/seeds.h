// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Seeds of property tests: each failure prints the one that failed.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace vicinity::test {

/// Runs property(generator) for `count` seeds, until one fails.
template <class Property>
void for_each_seed(unsigned count, Property&& property) {
  for (unsigned seed = 1; seed <= count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    property(random);
    if (::testing::Test::HasFailure()) return;
  }
}

inline int whole(std::mt19937& random, int least, int most) {
  return std::uniform_int_distribution<int>(least, most)(random);
}

inline double real(std::mt19937& random, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(random);
}

}  // namespace vicinity::test
