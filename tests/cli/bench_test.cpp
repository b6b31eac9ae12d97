// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity bench tick: what programs may rely on. Nothing here depends on how fast anything is.

#include <gtest/gtest.h>

#include "program.h"

namespace vicinity::cli_test {
namespace {

TEST(BenchTick, MeasuresEachNumberOfPointsBesideAnEmptyLoop) {
  const Folder folder;
  const Answer answer =
      folder.run({"bench", "tick", "--points", "50,700", "--seconds", "0.05", "--json"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  const auto json = answer.json();
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["points"], 50);
  EXPECT_EQ(json[1]["points"], 700);
  for (const auto& cost : json) {
    EXPECT_GE(cost["ticks"], 1);
    EXPECT_GT(cost["p50_us"], 0);
    EXPECT_LE(cost["p50_us"], cost["p99_us"]);
    EXPECT_LE(cost["p99_us"], cost["p9999_us"]);
    EXPECT_LE(cost["p9999_us"], cost["max_us"]);
    EXPECT_LE(cost["over_deadline"], cost["ticks"]);
    EXPECT_EQ(cost["over_deadline"] > 0, cost["max_us"] > 1000);
    EXPECT_GT(cost["felt"], 0.05) << "the arm is to be near something";
    EXPECT_LE(cost["empty_loop"]["p50_us"], cost["empty_loop"]["max_us"]);
  }
  EXPECT_TRUE(folder.files().empty());
}

TEST(BenchTick, TakesAFieldAndAnArmOfOnesOwn) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  folder.write("arm.urdf",
               "<robot name='arm'><link name='base'/><link name='bar'><collision><geometry>"
               "<box size='0.4 0.05 0.05'/></geometry></collision></link>"
               "<joint name='turn' type='continuous'><parent link='base'/><child link='bar'/>"
               "<axis xyz='0 0 1'/></joint></robot>");
  ASSERT_EQ(folder.run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
  const Answer answer = folder.run({"bench", "tick", "f.vicinity", "--robot", "arm.urdf", "--base",
                                    "0,0,0.1,0,0,0", "--points", "90", "--seconds", "0.02"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_NE(answer.out.find("empty"), std::string::npos);
}

}  // namespace
}  // namespace vicinity::cli_test
