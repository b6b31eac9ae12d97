// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity reproduce: one item at a time, its page, its verdict, and the same numbers again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "program.h"

namespace vicinity::cli_test {
namespace {

using testing::HasSubstr;
using testing::Not;

// Every CSV file below a folder, by its path from there.
std::map<std::string, std::string> tables(const std::filesystem::path& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    found[entry.path().lexically_relative(folder).string()] = text_of(entry.path());
  }
  return found;
}

TEST(Reproduce, MakesOneItemWithItsPageVerdictFigureAndData) {
  const Folder folder;
  const Answer answer = folder.run({"reproduce", "--only", "fig22", "-o", "r"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.err, "");
  const auto verdicts = nlohmann::json::parse(text_of(folder / "r/verdicts.json"));
  ASSERT_EQ(verdicts.size(), 1u);
  EXPECT_EQ(verdicts[0]["item"], "fig22");
  EXPECT_EQ(verdicts[0]["agrees"], true);
  EXPECT_THAT(std::string(verdicts[0]["why"]), HasSubstr("32, 25, 20, 15, 13, 0 N"));
  EXPECT_THAT(text_of(folder / "r/fig22/six_tracks.svg"), HasSubstr("<svg"));
  EXPECT_THAT(text_of(folder / "r/fig22/six_tracks.csv"),
              testing::StartsWith("track,way_vox,kind,rank,mu_Ns_m3,drag_N\n"));

  const std::string page = text_of(folder / "r/fig22/index.html");
  EXPECT_THAT(page, HasSubstr("vicinity reproduce --only fig22"));
  EXPECT_THAT(page, HasSubstr("href=\"six_tracks.csv\""));
  for (const char* outside : {"http://", "https://", "<script", "<link"}) {
    EXPECT_THAT(page, Not(HasSubstr(outside))) << "the page must open from disk";
  }
}

TEST(Reproduce, OneItemLeavesTheReportAndTheOtherVerdicts) {
  const Folder folder;
  std::filesystem::create_directories(folder / "r");
  folder.write("r/index.html", "the whole report");
  folder.write("r/verdicts.json",
               R"([{"item": "fig5", "agrees": true, "why": "a"},
                   {"item": "fig22", "agrees": false, "why": "b"}])");
  ASSERT_EQ(folder.run({"reproduce", "--only", "fig22", "-o", "r"}).code, 0);
  EXPECT_EQ(text_of(folder / "r/index.html"), "the whole report");
  const auto verdicts = nlohmann::json::parse(text_of(folder / "r/verdicts.json"));
  ASSERT_EQ(verdicts.size(), 2u);
  EXPECT_EQ(verdicts[0]["why"], "a");
  EXPECT_EQ(verdicts[1]["agrees"], true);
}

TEST(Reproduce, BuildsFromTheSamePartThatItLeavesBehind) {
  const Folder folder;
  ASSERT_EQ(folder.run({"reproduce", "--only", "fig12", "-o", "r"}).code, 0);
  const Answer built = folder.run({"build", "r/meshes/cube.stl", "--units", "mm", "--voxel-size",
                                   "0.005", "--q", "0", "-o", "cube.vicinity", "--json"});
  ASSERT_EQ(built.code, 0) << built.err;
  EXPECT_THAT(text_of(folder / "r/fig12/volumes.csv"),
              HasSubstr("cube," + built.json()["voxels"]["boundary"].dump() + ','));
}

TEST(Reproduce, TwoRunsGiveTheSameTables) {
  for (const char* item : {"fig8", "table1", "table2", "dynamics"}) {
    const Folder first, second;
    ASSERT_EQ(first.run({"reproduce", "--only", item, "-o", "r"}).code, 0);
    ASSERT_EQ(second.run({"reproduce", "--only", item, "-o", "r"}).code, 0);
    const auto tables_of_first = tables(first / "r");
    EXPECT_FALSE(tables_of_first.empty()) << item;
    EXPECT_TRUE(tables_of_first == tables(second / "r")) << item;
  }
}

TEST(Reproduce, TakesAFigureThatAnotherItemShows) {
  const Folder folder;
  ASSERT_EQ(folder.run({"reproduce", "--only", "fig29", "-o", "r"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "r/fig28/nonlinear.svg"));
}

TEST(Reproduce, RefusesAnItemThatThereIsNotAndWritesNothing) {
  const Folder folder;
  const Answer answer = folder.run({"reproduce", "--only", "tabel2", "-o", "r"});
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, HasSubstr("try table2"));
  EXPECT_EQ(std::ranges::count(answer.err, '\n'), 1);
  EXPECT_TRUE(folder.files().empty());
}

TEST(Reproduce, RefusesAFolderThatCannotBe) {
  const Folder folder;
  folder.write("r", "a file");
  const Answer answer = folder.run({"reproduce", "--only", "fig22", "-o", "r"});
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, HasSubstr("r: "));
}

}  // namespace
}  // namespace vicinity::cli_test
