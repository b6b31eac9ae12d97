// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity demo: everything a newcomer is promised is there, and can be made again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.h"

namespace vicinity::cli_test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Demo, LeavesAPageAFieldAndASceneThatBuildsTheSameField) {
  const Folder folder;
  const Answer answer = folder.run({"demo", "-o", "d"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.err, "");
  EXPECT_THAT(answer.out, HasSubstr("d/index.html"));

  const std::string page = text_of(folder / "d/index.html");
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,iVBOR"));
  for (const char* outside : {"http://", "https://", "<script", "<link"}) {
    EXPECT_THAT(page, Not(HasSubstr(outside))) << "the page must need nothing else";
  }

  for (const auto& mesh : std::filesystem::directory_iterator(folder / "d/meshes")) {
    const Answer checked = folder.run({"check", mesh.path().string(), "--units", "mm", "--json"});
    EXPECT_EQ(checked.code, 0);
    EXPECT_EQ(checked.json()["closed"], true) << mesh.path();
  }
  ASSERT_EQ(folder.run({"build", "d/scene.yaml", "-o", "again.vicinity"}).code, 0);
  EXPECT_TRUE(text_of(folder / "again.vicinity") == text_of(folder / "d/hot_cell.vicinity"));

  // The arm's log replays from the files that lie there, and something is felt.
  const Answer felt = folder.run({"replay", "d/hot_cell.vicinity", "--scene", "d/scene.yaml",
                                  "--trajectory", "d/arm_motion.csv", "-o", "felt.csv", "--json"});
  ASSERT_EQ(felt.code, 0) << felt.err;
  EXPECT_GT(felt.json()["strongest"]["force"], 0);
  EXPECT_EQ(felt.json()["statuses"]["ok"], 10'500);
  EXPECT_TRUE(text_of(folder / "felt.csv") == text_of(folder / "d/arm_felt.csv"));
}

TEST(Trace, WritesTheDocumentedColumns) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  ASSERT_EQ(folder.run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
  const Answer answer = folder.run({"trace", "f.vicinity", "--from", "-0.2,0,0.1", "--to",
                                    "0.3,0,0.1", "--speed", "0.5", "--rate", "100"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, testing::StartsWith("t,x,y,z,kind,object,rank,mu,mu_e,fx,fy,fz\n"));
  EXPECT_EQ(answer.err, "");
}

TEST(Slice, WritesAPicture) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  ASSERT_EQ(folder.run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
  for (const char* plane : {"--x", "--y", "--z"}) {
    const Answer answer = folder.run({"slice", "f.vicinity", plane, "-0.02", "-o", "s.png"});
    ASSERT_EQ(answer.code, 0) << answer.err;
    EXPECT_EQ(text_of(folder / "s.png").substr(1, 3), "PNG");
  }
}

TEST(Query, JsonHasTheDocumentedKeys) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  ASSERT_EQ(folder.run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
  const Answer answer = folder.run({"query", "f.vicinity", "-0.05", "0.01", "-0.065", "--json"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  const auto json = answer.json();
  EXPECT_EQ(json["kind"], "neighbour");
  EXPECT_EQ(json["object"], "block");
  EXPECT_EQ(json["rank"], 1);
  EXPECT_EQ(json["viscosity"], 30);
  EXPECT_TRUE(json.contains("distance"));
  EXPECT_TRUE(json["distance"].is_null());
}

}  // namespace
}  // namespace vicinity::cli_test
