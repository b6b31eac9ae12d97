// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Logs, arms and options that vicinity replay cannot use: exit code 2, one sentence, no file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "program.h"
#include "small_arm.h"

namespace vicinity::cli_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct ReplayRefusal {
  const char* claim;
  const char* log;  // text of the joint log
  std::vector<std::string> more;
  const char* sentence_says;
};

constexpr const char* good = "t,turn,bend,slide\n0,0,0,0\n0.01,0.01,0,0\n0.02,0.02,0,0\n";

const ReplayRefusal replay_refusals[] = {
    {"NanCell", "t,turn,bend,slide\n0,0,0,0\n0.01,nan,0,0\n", {}, "log.csv:3: column 'turn'"},
    {"InfiniteCell", "t,turn,bend,slide\n0,0,0,0\n0.01,0,inf,0\n", {}, "log.csv:3"},
    {"EmptyCell", "t,turn,bend,slide\n0,0,0,0\n\n0.01,0,,0\n", {}, "log.csv:4: column 'bend'"},
    {"WordAsCell", "t,turn,bend,slide\n0,0,0,off\n", {}, "'off'"},
    {"TimeThatStandsStill",
     "t,turn,bend,slide\n0,0,0,0\n0.01,0,0,0\n0.01,0,0,0\n",
     {},
     "log.csv:4: time does not rise"},
    {"TimeThatRunsBackwards",
     "t,turn,bend,slide\n0,0,0,0\n0.01,0,0,0\n0.005,0,0,0\n",
     {},
     "0.005 s after 0.01 s"},
    {"LineThatWasCutOff",
     "t,turn,bend,slide\n0,0,0,0\n0.01,0,0",
     {},
     "log.csv:3: the line is too short"},
    {"DecimalCommas",
     "t,turn,bend,slide\n0,0,0,0,\n0,01,0,02,0,0\n",
     {},
     "log.csv:3: the line is too long: a decimal comma?; found 6 cells where the header has 4"},
    {"EmptyLog", "", {}, "log.csv"},
    {"LogOfBlankLines", "\n\n  \n", {}, "no header"},
    {"HeaderAlone", "t,turn,bend,slide\n", {}, "at least two samples"},
    {"OneSample", "t,turn,bend,slide\n0,0,0,0\n", {}, "at least two samples"},
    {"NoTime", "Time,turn,bend,slide\n0,0,0,0\n", {}, "--columns t=Time"},
    {"NoColumnForAJoint", "t,turn,bent,slide\n0,0,0,0\n", {}, "--columns bend=bent"},
    {"TheTimeIsNotProposedForAJoint", good, {"--columns", "bend=T"}, "bend=COLUMN"},
    {"TwoColumnsOfOneName", "t,turn,turn,bend,slide\n0,0,0,0,0\n", {}, "columns 2 and 3"},
    {"UnitThatDoesNotFit", "t,turn [mm],bend,slide\n0,0,0,0\n", {}, "one of rad, deg, °"},
    {"VelocityOfSomeJoints", "t,turn,bend,slide,qd_turn\n0,0,0,0,0\n", {}, "1 of 3"},
    {"ColumnsWithoutEquals", good, {"--columns", "t"}, "'t'"},
    {"ColumnsWithoutAColumn", good, {"--columns", "t="}, "lacks a side"},
    {"ColumnsTwice", good, {"--columns", "t=t,t=turn"}, "two columns"},
    {"ColumnThatIsNotThere", good, {"--columns", "turn=tern"}, "--columns turn=turn"},
    {"QuantityThatIsNone", good, {"--columns", "trun=turn"}, "try turn"},
    {"FactorOfZero", good, {"--columns", "t=t*0"}, "factor"},
    {"RateOfZero", good, {"--rate", "0"}, "--rate"},
    {"RateOfAMegahertz", good, {"--rate", "1e6"}, "--rate"},
    {"NoDuration", good, {"--duration", "0"}, "--duration"},
    {"EndlessDuration", good, {"--duration", "1e12"}, "--duration"},
    {"DurationThatIsNone", good, {"--duration", "nan"}, "--duration"},
    {"BaseOfThreeNumbers", good, {"--base", "0,0,0"}, "6 numbers"},
    {"LinkToExcludeThatIsNone", good, {"--exclude", "uper"}, "uper"},
    {"ToolThatIsNone", good, {"--tool", "fingre"}, "try finger"},
    {"DeviceThatIsNone", good, {"--device", "tuch"}, "try 'touch'"},
    {"DeviceThatIsLikeNone", good, {"--device", "foo"}, "one of falcon, lambda.7, omega.3"},
    {"DeviceFileThatIsNone", good, {"--device", "nowhere.yaml"}, "nowhere.yaml"},
    {"StrictWithoutKnownDamping", good, {"--device", "touch"}, "device mode"},
    {"ModeThatIsNone", good, {"--device", "touch", "--mode", "lax"}, "strict, device"},
    {"MasterOfTwoNumbers", good, {"--master", "1,2"}, "4 numbers"},
    {"MasterWithoutLever", good, {"--master", "1,1,0,1"}, "lever"},
    {"MemoryThatIsNone", good, {"--memory", "long"}, "long"},
    {"CodingThatIsNone", good, {"--coding", "loud"}, "loud"},
    {"ModeWithoutADevice", good, {"--mode", "device"}, "--device"},
    {"PointsByNumberAndDensity", good, {"--points", "9", "--points-per-m2", "9"}, "--points"},
    {"NoPoints", good, {"--points", "0"}, "--points"},
    {"NegativeDensity", good, {"--points-per-m2", "-5"}, "-5"},
    {"NoDensity", good, {"--points-per-m2", "0"}, "a density above zero"},
    {"NoLinkThatFeels", good, {"--exclude", "upper,lower,finger"}, "fewer links in --exclude"},
    {"PictureOfUnknownKind", good, {"--plot", "felt.bmp"}, ".png"},
    {"PictureInNoFolder", good, {"--plot", "nowhere/felt.svg"}, "nowhere"},
    {"OutputThatIsAFolder", good, {"-o", "."}, "is a folder"},
    {"OutputInNoFolder", good, {"-o", "nowhere/felt.csv"}, "nowhere"},
    {"SceneWithoutRobot", good, {"--scene", "scene.yaml"}, "no robot"},
};

class ReplayRefused : public testing::TestWithParam<ReplayRefusal> {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    folder_->write("scene.yaml", small_scene);
    folder_->write("arm.urdf", small_arm);
    folder_->write("log.csv", good);
    ASSERT_EQ(folder_->run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static Folder* folder_;
};

Folder* ReplayRefused::folder_ = nullptr;

void expect_refused(const Folder& folder, const std::vector<std::string>& arguments,
                    const std::string& sentence_says) {
  const auto files = folder.files();
  const Answer answer = folder.run(arguments);
  EXPECT_EQ(answer.code, 2) << answer.out << answer.err;
  EXPECT_THAT(answer.err, StartsWith("vicinity: "));
  EXPECT_THAT(answer.err, HasSubstr(sentence_says));
  EXPECT_EQ(std::ranges::count(answer.err, '\n'), 1) << answer.err;
  EXPECT_EQ(folder.files(), files) << "nothing may be left behind";
}

TEST_P(ReplayRefused, WithOneSentence) {
  folder_->write("log.csv", GetParam().log);
  std::vector<std::string> arguments = {"replay",   "f.vicinity",   "--robot",
                                        "arm.urdf", "--trajectory", "log.csv"};
  const bool writes = std::ranges::count(GetParam().more, "-o") > 0;
  if (!writes) arguments.insert(arguments.end(), {"-o", "felt.csv"});
  arguments.insert(arguments.end(), GetParam().more.begin(), GetParam().more.end());
  expect_refused(*folder_, arguments, GetParam().sentence_says);
}

INSTANTIATE_TEST_SUITE_P(, ReplayRefused, testing::ValuesIn(replay_refusals),
                         [](const auto& which) { return which.param.claim; });

TEST_F(ReplayRefused, WithoutAFieldARobotOrALog) {
  folder_->write("log.csv", good);
  folder_->write("garbage", std::string(5000, 'x'));
  folder_->write("flat.urdf",
                 "<robot name='flat'><link name='a'/><link name='b'><collision><geometry>"
                 "<box size='-1 1 1'/></geometry></collision></link><joint name='turn' "
                 "type='continuous'><parent link='a'/><child link='b'/></joint></robot>");
  const auto refused = [&](const std::vector<std::string>& more, const std::string& says) {
    std::vector<std::string> arguments = {"replay"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.insert(arguments.end(), {"-o", "felt.csv"});
    expect_refused(*folder_, arguments, says);
  };
  refused({}, "FIELD");
  refused({"nowhere.f", "--robot", "arm.urdf", "--trajectory", "log.csv"}, "nowhere.f");
  refused({"garbage", "--robot", "arm.urdf", "--trajectory", "log.csv"}, "garbage");
  refused({"f.vicinity", "--trajectory", "log.csv"}, "--robot");
  refused({"f.vicinity", "--robot", "nowhere.urdf", "--trajectory", "log.csv"}, "nowhere.urdf");
  refused({"f.vicinity", "--robot", "garbage", "--trajectory", "log.csv"}, "garbage");
  refused({"f.vicinity", "--robot", "flat.urdf", "--trajectory", "log.csv"}, "size x");
  refused({"f.vicinity", "--robot", "arm.urdf"}, "--trajectory");
  refused({"f.vicinity", "--robot", "arm.urdf", "--trajectory", "nowhere.csv"}, "nowhere.csv");
  refused({"f.vicinity", "--robot", "arm.urdf", "--trajectory", "."}, ".: the log");
}

}  // namespace
}  // namespace vicinity::cli_test
