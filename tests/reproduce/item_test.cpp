// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The table of items, and how checks become a verdict.

#include "reproduce/item.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "vicinity/geometry/error.h"

namespace vicinity::report {
namespace {

TEST(Items, ShowEveryFigureAndTableWithAResult) {
  for (const char* name :
       {"fig2",  "fig4",  "fig5",  "fig6",   "fig7",  "fig8",    "fig9",  "fig11",
        "fig12", "fig13", "fig14", "fig16",  "fig17", "fig18",   "fig19", "table1",
        "fig20", "fig21", "fig22", "fig23",  "fig24", "fig25",   "fig26", "fig27",
        "fig28", "fig29", "fig30", "table2", "fig34", "dynamics"}) {
    EXPECT_NO_THROW(item_named(name)) << name;
  }
}

TEST(Items, HaveNamesOfTheirOwnAndSayWhatWasChosen) {
  std::set<std::string> names;
  for (const Item& item : items()) {
    EXPECT_TRUE(names.insert(item.name).second) << item.name;
    for (const std::string& other : item.also) EXPECT_TRUE(names.insert(other).second) << other;
    EXPECT_FALSE(item.title.empty() || item.paper.empty() || item.chosen.empty()) << item.name;
  }
}

TEST(Items, OfAnUnknownNameNameTheNearest) {
  try {
    item_named("tabel1");
    FAIL() << "found";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("try table1"));
  }
}

TEST(Verdict, AgreesWhereAllChecksHoldAndNamesThoseThatDoNot) {
  const Check holds{"one", "1 N", true}, fails{"two", "2 N", false};
  EXPECT_TRUE(verdict_of({holds, holds}).agrees);
  const Verdict verdict = verdict_of({holds, fails});
  EXPECT_FALSE(verdict.agrees);
  EXPECT_THAT(verdict.why, testing::HasSubstr("two (2 N)"));
  EXPECT_THAT(verdict.why, testing::Not(testing::HasSubstr("one")));
  EXPECT_FALSE(verdict_of({}).agrees) << "nothing measured is nothing shown";
}

}  // namespace
}  // namespace vicinity::report
