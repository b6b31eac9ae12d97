// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Bad input and bad options: exit code 2, one sentence on standard error, nothing written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>

#include "program.h"

namespace vicinity::cli_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

struct Refusal {
  const char* claim;
  std::vector<std::string> arguments;
  const char* sentence_says;
};

const Refusal refusals[] = {
    {"UnknownCommandNamesTheNearest", {"biuld", "scene.yaml"}, "build"},
    {"UnknownOptionNamesTheNearest",
     {"build", "scene.yaml", "-o", "x.f", "--voxel-sise", "1"},
     "--voxel-size"},
    {"UnknownFlagNamesTheNearest", {"info", "f.vicinity", "--jsno"}, "--json"},
    {"UnknownShortOption", {"info", "f.vicinity", "-q"}, "-q"},
    {"OneWordTooMany", {"info", "f.vicinity", "more"}, "more"},
    {"UnknownSecondWordNamesTheNearest", {"bench", "tik"}, "bench tick"},
    {"UnknownOptionOfASecondWord", {"bench", "tick", "--pionts", "9"}, "--points"},
    {"NoPointsToBench", {"bench", "tick", "--points", "0"}, "--points"},
    {"NoTimeToBench", {"bench", "tick", "--seconds", "-1"}, "--seconds"},
    {"AnArmToBenchWithoutAField", {"bench", "tick", "--robot", "arm.urdf"}, "FIELD"},
    {"MissingInput", {"build"}, "INPUT"},
    {"MissingOutput", {"build", "scene.yaml"}, "--output"},
    {"OptionWithoutValue", {"build", "scene.yaml", "-o"}, "--output"},
    {"NumberThatIsNone", {"build", "scene.yaml", "-o", "x.f", "--m", "four"}, "--m"},
    {"MissingScene", {"build", "nowhere.yaml", "-o", "x.f"}, "nowhere.yaml"},
    {"MissingMesh", {"check", "nowhere.stl"}, "nowhere.stl"},
    {"MissingField", {"info", "nowhere.f"}, "nowhere.f"},
    {"FolderAsField", {"info", "."}, "."},
    {"FolderAsMesh", {"check", "."}, "."},
    {"GarbageAsField", {"info", "garbage.f"}, "garbage.f"},
    {"GarbageAsFieldForQuery", {"query", "garbage.f", "0", "0", "0"}, "garbage.f"},
    {"GarbageAsFieldForSlice", {"slice", "garbage.f", "--z", "0", "-o", "x.png"}, "garbage.f"},
    {"GarbageAsFieldForTrace",
     {"trace", "garbage.f", "--from", "0,0,0", "--to", "1,0,0"},
     "garbage.f"},
    {"EmptyFileAsField", {"info", "empty.f"}, "empty.f"},
    {"CutField", {"info", "cut.f"}, "cut.f"},
    {"GarbageAsScene", {"build", "garbage.yaml", "-o", "x.f"}, "garbage.yaml"},
    {"EmptyScene", {"build", "empty.yaml", "-o", "x.f"}, "empty.yaml"},
    {"UnknownKeyInSceneNamesTheNearest", {"build", "typo.yaml", "-o", "x.f"}, "voxel_size"},
    {"UnknownUnit", {"check", "square.stl", "--units", "furlong"}, "furlong"},
    {"UnknownUnitOfAMesh",
     {"build", "square.stl", "--units", "mn", "-o", "x.f"},
     "mm, cm, m or in"},
    {"UnitsOfAScene", {"build", "scene.yaml", "--units", "mm", "-o", "x.f"}, "--units"},
    {"FolderOfMeshesOfAMesh",
     {"build", "square.stl", "--units", "mm", "--meshes", "nowhere", "-o", "x.f"},
     "--meshes"},
    {"MeshWithoutUnit", {"build", "square.stl", "-o", "x.f"}, "inch"},
    {"MeshOfUnknownKind", {"check", "garbage.step"}, "garbage.step"},
    {"UnknownShape", {"build", "scene.yaml", "-o", "x.f", "--shape", "spere"}, "sphere"},
    {"UnknownInner", {"build", "scene.yaml", "-o", "x.f", "--inner", "wind"}, "winding"},
    {"UnknownCoding", {"build", "scene.yaml", "-o", "x.f", "--coding", "loud"}, "loud"},
    {"CodingOfNoNumbers", {"build", "scene.yaml", "-o", "x.f", "--coding", "1,,2"}, "1,,2"},
    {"CodingTooShort", {"build", "scene.yaml", "-o", "x.f", "--q", "9"}, "q = 9"},
    {"NegativeViscosity", {"build", "scene.yaml", "-o", "x.f", "--coding", "3,2,-1"}, "-1"},
    {"RankRadiusOfZero", {"build", "scene.yaml", "-o", "x.f", "--m", "0"}, "m"},
    {"TooManyRanks", {"build", "scene.yaml", "-o", "x.f", "--q", "33", "--coding", "jnd"}, "33"},
    {"VoxelsOfNoSize", {"build", "scene.yaml", "-o", "x.f", "--voxel-size", "0"}, "voxel"},
    {"VoxelsTooSmallForTheGrid",
     {"build", "scene.yaml", "-o", "x.f", "--voxel-size", "1e-9"},
     "voxel"},
    {"BoundsThatAreNone", {"build", "scene.yaml", "-o", "x.f", "--bounds", "1,2,3"}, "--bounds"},
    {"FlatBounds", {"build", "scene.yaml", "-o", "x.f", "--bounds", "0,0,0,1,1,0"}, "--bounds"},
    {"OutputInNoFolder", {"build", "scene.yaml", "-o", "nowhere/x.f"}, "nowhere"},
    {"OutputThatIsAFolder", {"build", "scene.yaml", "-o", "."}, "."},
    {"NegativeThreads", {"build", "scene.yaml", "-o", "x.f", "--threads", "-3"}, "--threads"},
    {"QueryWithTwoNumbers", {"query", "f.vicinity", "1", "2"}, "POINT"},
    {"QueryOfNoPoint", {"query", "f.vicinity", "1", "2", "nan"}, "'nan' is not a finite number"},
    {"SliceWithoutPlane", {"slice", "f.vicinity", "-o", "x.png"}, "--z"},
    {"SliceOutsideTheWorkspace", {"slice", "f.vicinity", "--z", "99", "-o", "x.png"}, "99"},
    {"SliceBesideItsBox",
     {"slice", "f.vicinity", "--z", "0", "--box", "-1,-1,0.01,1,1,0.02", "-o", "x.png"},
     "z from 0.01 to 0.02 m"},
    {"SliceAsUnknownPicture", {"slice", "f.vicinity", "--z", "0", "-o", "x.bmp"}, ".png"},
    {"TraceFromNowhere", {"trace", "f.vicinity", "--from", "here", "--to", "0,0,0"}, "--from"},
    {"TraceWithoutSpeed",
     {"trace", "f.vicinity", "--from", "0,0,0", "--to", "1,0,0", "--speed", "0"},
     "speed"},
    {"TraceWithUnknownMemory",
     {"trace", "f.vicinity", "--from", "0,0,0", "--to", "1,0,0", "--memory", "long"},
     "long"},
    {"ExportAsUnknownFormat", {"export", "f.vicinity", "-o", "x.csv"}, ".npy"},
    {"ExportOfUnknownQuantity",
     {"export", "f.vicinity", "-o", "x.npy", "--what", "colour"},
     "viscosity"},
    {"ExportOfDistancesThatAreNotKept",
     {"export", "f.vicinity", "-o", "x.npy", "--what", "distance"},
     "--shape distance"},
    {"ExportOutsideTheWorkspace",
     {"export", "f.vicinity", "-o", "x.npy", "--box", "50,50,50,51,51,51"},
     "--box"},
    {"BuildIntoNothing", {"build", "scene.yaml", "-o", ""}, "an empty name"},
    {"DemoIntoNothing", {"demo", "-o", ""}, "an empty name"},
    {"PlotOfNoName",
     {"trace", "f.vicinity", "--from", "0,0,0", "--to", "1,0,0", "--plot", ""},
     "an empty name"},
    {"DemoInAFile", {"demo", "-o", "scene.yaml"}, "scene.yaml"},
};

class Refused : public testing::TestWithParam<Refusal> {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    folder_->write("scene.yaml", small_scene);
    folder_->write("garbage.f", std::string(5000, 'x'));
    folder_->write("garbage.step", "ISO-10303-21;");
    folder_->write("garbage.yaml", "}{ : - [\x01");
    folder_->write("typo.yaml", std::string(small_scene).replace(0, 10, "voxel_sise"));
    folder_->write("empty.yaml", "");
    folder_->write("empty.f", "");
    folder_->write("square.stl",
                   "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\n"
                   "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n");
    ASSERT_EQ(folder_->run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
    const std::string field = text_of(*folder_ / "f.vicinity");
    folder_->write("cut.f", field.substr(0, field.size() / 2));
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static Folder* folder_;
};

Folder* Refused::folder_ = nullptr;

TEST_P(Refused, WithOneSentence) {
  const auto files = folder_->files();
  const Answer answer = folder_->run(GetParam().arguments);
  EXPECT_EQ(answer.code, 2) << answer.out << answer.err;
  EXPECT_THAT(answer.err, StartsWith("vicinity: "));
  EXPECT_THAT(answer.err, HasSubstr(GetParam().sentence_says));
  EXPECT_EQ(std::ranges::count(answer.err, '\n'), 1) << answer.err;
  EXPECT_EQ(folder_->files(), files) << "nothing may be left behind";
}

INSTANTIATE_TEST_SUITE_P(, Refused, testing::ValuesIn(refusals),
                         [](const auto& which) { return which.param.claim; });

TEST(Numbers, ThatAreNotFiniteAreRefusedByEveryCommand) {
  const Folder folder;
  const std::vector<std::vector<std::string>> commands = {
      {"build", "s.yaml", "-o", "f", "--voxel-size", "nan"},
      {"build", "s.yaml", "-o", "f", "--skin", "inf"},
      {"trace", "f", "--from", "0,0,0", "--to", "1,0,0", "--speed=-inf"},
      {"trace", "f", "--from", "0,0,0", "--to", "1,0,0", "--area", "1e999"},
      {"slice", "f", "-o", "s.png", "--z", "nan"},
      {"query", "f", "0", "inf", "0"},
      {"replay", "f", "--points-per-m2", "nan"},
      {"replay", "f", "--rate", "nan"},
      {"bench", "tick", "--seconds", "nan"},
      {"simulate", "--demo", "-o", "d", "--step-ms", "nan"},
      {"serve", "f", "--seconds", "nan"},
  };
  for (const auto& command : commands) {
    const Answer answer = folder.run(command);
    EXPECT_EQ(answer.code, 2) << command[0];
    EXPECT_THAT(answer.err, testing::AnyOf(HasSubstr("is not a finite number; try"),
                                           HasSubstr("built without the viewer")))
        << command[0];
  }
  EXPECT_TRUE(folder.files().empty());
}

// A limit on file size fails a write as a full disk does.
TEST(FullDisk, UnderStandardOutputIsNoFaultOfTheProgram) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  ASSERT_EQ(folder.run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);  // children take it over
  const rlimit small = {200, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const Answer answer = folder.run({"info", "f.vicinity", "--json"});
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(answer.code, 1);
  EXPECT_THAT(answer.err, HasSubstr("standard output could not be written"));
  EXPECT_THAT(answer.err, testing::Not(HasSubstr("should not have happened")));
}

TEST(Help, AloneItIsFriendly) {
  const Folder folder;
  const Answer answer = folder.run({});
  EXPECT_EQ(answer.code, 0);
  EXPECT_THAT(answer.out, HasSubstr("vicinity demo"));
  EXPECT_EQ(answer.err, "");
}

TEST(Help, EveryCommandShowsAnExampleOfItself) {
  const Folder folder;
  for (const char* command :
       {"check", "build", "info", "query", "trace", "replay", "slice", "export", "demo"}) {
    const Answer answer = folder.run({command, "--help"});
    EXPECT_EQ(answer.code, 0) << command;
    EXPECT_THAT(answer.out, HasSubstr(std::string("Example:\n  vicinity ") + command)) << command;
  }
}

TEST(Help, VersionIsOneLine) {
  const Folder folder;
  const Answer answer = folder.run({"--version"});
  EXPECT_EQ(answer.code, 0);
  EXPECT_THAT(answer.out, testing::MatchesRegex("vicinity [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

}  // namespace
}  // namespace vicinity::cli_test
