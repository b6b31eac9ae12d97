// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What an output may replace: an older file, and nothing that is read, or is no file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "program.h"
#include "small_arm.h"

namespace vicinity::cli_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Taken {
  const char* claim;
  std::vector<std::string> arguments;
  const char* named;          // in the sentence
  const char* sentence_says;  // too
};

const std::vector<std::string> track = {"trace", "f.vicinity", "--from", "0,0,0", "--to", "1,0,0"};

std::vector<std::string> traced(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = track;
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> replayed(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"replay", "f.vicinity",  "--robot",      "arm.urdf",
                                        "--base", "0,0,0,0,0,0", "--trajectory", "log.csv"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

const Taken taken[] = {
    {"TheMeshThatIsBuilt", {"build", "m.stl", "--units", "in", "-o", "m.stl"}, "m.stl", "lost"},
    {"TheSceneThatIsBuilt", {"build", "s.yaml", "-o", "./s.yaml"}, "s.yaml", "lost"},
    {"AMeshOfTheScene", {"build", "s.yaml", "-o", "m.stl"}, "m.stl", "lost"},
    {"TheFieldThatIsTraced", traced({"-o", "f.vicinity"}), "f.vicinity", "lost"},
    {"TheFieldByALink", traced({"-o", "link_to_field"}), "link_to_field", "lost"},
    {"TheFieldThatIsExported", {"export", "f.json", "-o", "f.npy"}, "f.json", "lost"},
    {"TheFieldThatIsDrawn", {"slice", "f.png", "--z", "0", "-o", "f.png"}, "f.png", "lost"},
    {"TheLogThatIsReplayed", replayed({"-o", "log.csv"}), "log.csv", "lost"},
    {"TheArmThatIsReplayed", replayed({"-o", "arm.urdf"}), "arm.urdf", "lost"},
    {"TheOtherOutput", traced({"-o", "q.svg", "--plot", "./q.svg"}), "q.svg", "another output"},
    {"APipe", traced({"-o", "pipe"}), "pipe", "not replaced"},
    {"ALinkToAPipe", traced({"-o", "link_to_pipe"}), "link_to_pipe", "not replaced"},
    {"AFolder", traced({"--plot", "folder.svg"}), "folder.svg", "is a folder"},
};

class NotReplaced : public testing::TestWithParam<Taken> {};

TEST_P(NotReplaced, AndSaysSo) {
  namespace fs = std::filesystem;
  const Folder folder;
  folder.write("m.stl",
               "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
               "vertex 0 1 0\nendloop\nendfacet\nendsolid\n");
  folder.write("s.yaml", "voxel_size: 0.1\nobjects: [{name: m, mesh: m.stl, units: m}]\n");
  folder.write("arm.urdf", small_arm);
  folder.write("log.csv", log_of(parabola, {0, 0.01, 0.02}));
  ASSERT_EQ(folder.run({"build", "s.yaml", "-o", "f.vicinity"}).code, 0);
  fs::copy_file(folder / "f.vicinity", folder / "f.json");
  fs::copy_file(folder / "f.vicinity", folder / "f.png");
  fs::create_symlink("f.vicinity", folder / "link_to_field");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder / "link_to_pipe");
  fs::create_directory(folder / "folder.svg");
  const auto names = folder.files();
  std::vector<std::string> texts;
  for (const std::string& name : names) {
    texts.push_back(fs::is_regular_file(folder / name) ? text_of(folder / name) : "");
  }

  const Answer answer = folder.run(GetParam().arguments);
  EXPECT_EQ(answer.code, 2) << answer.out;
  EXPECT_THAT(answer.err, AllOf(HasSubstr(GetParam().named), HasSubstr(GetParam().sentence_says)));
  ASSERT_EQ(folder.files(), names);
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (!texts[n].empty()) {
      EXPECT_EQ(text_of(folder / names[n]), texts[n]) << names[n];
    }
  }
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

INSTANTIATE_TEST_SUITE_P(, NotReplaced, testing::ValuesIn(taken),
                         [](const auto& which) { return which.param.claim; });

TEST(Replaced, IsAnOlderFileAndWhatALinkLeadsTo) {
  const Folder folder;
  folder.write("s.yaml", small_scene);
  ASSERT_EQ(folder.run({"build", "s.yaml", "-o", "f.vicinity"}).code, 0);
  folder.write("old.csv", "old");
  std::filesystem::create_symlink("old.csv", folder / "link.csv");
  const Answer answer = folder.run(traced({"-o", "link.csv", "--plot", "new.svg"}));
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.csv"));
  EXPECT_THAT(text_of(folder / "old.csv"), testing::StartsWith("t,x,y,z,"));
}

}  // namespace
}  // namespace vicinity::cli_test
