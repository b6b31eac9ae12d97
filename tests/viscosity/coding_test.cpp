// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/coding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

using ::testing::ElementsAre;

TEST(Coding, NamedCodingsAreThePapersTables) {
  EXPECT_THAT(named_coding("paper", 6).mu, ElementsAre(32, 25, 20, 17, 15, 13));
  EXPECT_THAT(named_coding("linear", 10).mu, ElementsAre(32, 29, 26, 23, 20, 17, 14, 11, 8, 5));
  EXPECT_THAT(named_coding("nonlinear", 11).mu, ElementsAre(32, 20, 13, 11, 10, 9, 8, 0, 0, 0, 0));
}

TEST(Coding, NamedCodingsHaveOneValueForEachRank) {
  for (const char* name : {"linear", "nonlinear", "jnd"}) {
    for (int q = 0; q <= 32; ++q) {
      const Coding coding = named_coding(name, q);
      EXPECT_EQ(coding.mu.size(), static_cast<std::size_t>(q));
      EXPECT_NO_THROW(check_coding(coding, q, name));
      EXPECT_TRUE(std::is_sorted(coding.mu.rbegin(), coding.mu.rend())) << name;
    }
  }
}

TEST(Coding, JndStepsByTheJustNoticeableRatio) {
  const Coding jnd = named_coding("jnd", 8);
  EXPECT_DOUBLE_EQ(jnd.mu.front(), 32);
  for (std::size_t n = 1; n < 8; ++n) EXPECT_NEAR(jnd.mu[n - 1] / jnd.mu[n], 1.34, 1e-12);
  EXPECT_NEAR(jnd.mu.back(), 4.1, 0.05);
}

TEST(Coding, AnUnknownNameAndTooManyRanksForThePaperAreErrors) {
  EXPECT_THROW(named_coding("liner", 6), Error);
  EXPECT_THROW(named_coding("", 0), Error);
  EXPECT_THROW(named_coding("paper", 7), Error);
}

TEST(Coding, ShortNegativeAndNonFiniteCodingsAreErrors) {
  EXPECT_THROW(check_coding({{3, 2}, 100}, 3, "here"), Error);
  EXPECT_NO_THROW(check_coding({{3, 2, 1}, 100}, 2, "here"));
  EXPECT_THROW(check_coding({{3, -2}, 100}, 2, "here"), Error);
  EXPECT_THROW(check_coding({{3, 2}, -1}, 2, "here"), Error);
  EXPECT_THROW(check_coding({{std::numeric_limits<double>::quiet_NaN()}, 1}, 1, "here"), Error);
  EXPECT_THROW(check_coding({{1}, std::numeric_limits<double>::infinity()}, 1, "here"), Error);
}

TEST(Coding, ViscosityByDistanceMeetsTheRanksAtTheirNearSideAndFadesToZero) {
  const Coding coding{{32, 25, 20, 17, 15, 13}, 100};
  for (int n = 1; n <= 6; ++n)
    EXPECT_DOUBLE_EQ(coding.at_distance(4.0 * (n - 1), 4, 6), coding.of_rank(n));
  EXPECT_DOUBLE_EQ(coding.at_distance(2, 4, 6), 28.5);
  EXPECT_DOUBLE_EQ(coding.at_distance(22, 4, 6), 6.5);
  EXPECT_DOUBLE_EQ(coding.at_distance(24, 4, 6), 0);
  EXPECT_DOUBLE_EQ(coding.at_distance(1e300, 4, 6), 0);
  EXPECT_DOUBLE_EQ(coding.at_distance(-1, 4, 6), 32);
  EXPECT_DOUBLE_EQ(coding.at_distance(0, 4, 0), 0);
}

TEST(Coding, ViscosityByDistanceIsContinuous) {
  const Coding coding{{32, 20, 13, 11, 10, 9}, 100};
  const double step = 1e-3;
  const double steepest = 12.0 / 3;
  for (double d = -1; d < 20; d += step) {
    EXPECT_LE(std::abs(coding.at_distance(d + step, 3, 6) - coding.at_distance(d, 3, 6)),
              steepest * step * 1.0001);
  }
}

}  // namespace
}  // namespace vicinity
