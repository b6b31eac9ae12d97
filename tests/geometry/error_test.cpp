// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/geometry/error.h"

#include <gtest/gtest.h>

namespace vicinity {
namespace {

TEST(Error, IsOneSentenceWithEveryPartThatIsThere) {
  const Error error({.where = "bench.stl",
                     .what = "is cut short",
                     .found = "84 bytes",
                     .expected = "184",
                     .hint = "exporting it again"});
  EXPECT_STREQ(error.what(),
               "bench.stl: is cut short; found 84 bytes, expected 184; try exporting it again");
}

TEST(Error, LeavesOutPartsThatAreEmpty) {
  EXPECT_STREQ(Error({.what = "no objects"}).what(), "no objects");
  EXPECT_STREQ(Error({.what = "no objects", .expected = "one or more"}).what(),
               "no objects; expected one or more");
}

}  // namespace
}  // namespace vicinity
