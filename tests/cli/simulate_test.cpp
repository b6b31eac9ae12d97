// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity simulate: a small study of one's own scene and arm, and sentences for what cannot be
// one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "program.h"

namespace vicinity::cli_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

#ifndef VICINITY_SIMULATION

TEST(Simulate, SaysThatThisBuildHasNone) {
  const Folder folder;
  const Answer answer = folder.run({"simulate", "--demo", "-o", "s"});
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, HasSubstr("VICINITY_SIMULATION"));
}

#else

// A gantry of three slides with a ball for a tool.
std::string gantry(bool with_inertia) {
  std::string text = "<robot name=\"gantry\"><link name=\"frame\"/>", parent = "frame";
  for (const std::string name : {"x", "y", "z"}) {
    const std::string axis = name == "x" ? "1 0 0" : name == "y" ? "0 1 0" : "0 0 1";
    text += "<joint name=\"" + name + "\" type=\"prismatic\"><parent link=\"" + parent +
            "\"/><child link=\"" + name + "_slide\"/><axis xyz=\"" + axis +
            "\"/><limit lower=\"-1\" upper=\"1\" velocity=\"2\" effort=\"2000\"/></joint><link "
            "name=\"" +
            name + "_slide\">";
    if (with_inertia) {
      text +=
          "<inertial><mass value=\"1\"/><inertia ixx=\"0.001\" ixy=\"0\" ixz=\"0\" iyy=\"0.001\" "
          "iyz=\"0\" izz=\"0.001\"/></inertial>";
    }
    if (name == "z")
      text += "<collision><geometry><sphere radius=\"0.02\"/></geometry></collision>";
    text += "</link>";
    parent = name + "_slide";
  }
  return text + "</robot>";
}

constexpr const char* scene =
    "voxel_size: 0.01\n"
    "defaults: {m: 2, q: 3}\n"
    "objects:\n"
    "  - name: block\n"
    "    primitive: {box: {size: [0.3, 0.3, 0.2]}}\n"
    "    pose: {xyz: [0.002, 0.002, -0.1]}\n";
constexpr const char* robot = "robot:\n  urdf: gantry.urdf\n";
constexpr const char* tasks =
    "tasks:\n"
    "  - {name: down, path: [[0, 0, 0.2], [0, 0, 0.04]], points: [0, 0, 1], sight: [0, 0, 1],\n"
    "     stop: feel, limit: 5}\n";

struct Bench {
  Bench() {
    folder.write("cell.yaml", std::string(scene) + robot);
    folder.write("bare.yaml", scene);
    folder.write("gantry.urdf", gantry(true));
    folder.write("light.urdf", gantry(false));
    folder.write("tasks.yaml", tasks);
  }
  Answer run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "simulate");
    arguments.insert(arguments.end(), {"-o", "s", "--trials", "3"});
    return folder.run(arguments);
  }
  void refused(const std::vector<std::string>& arguments, const std::string& sentence) const {
    const Answer answer = run(arguments);
    EXPECT_EQ(answer.code, 2) << answer.err;
    EXPECT_THAT(answer.err, HasSubstr(sentence));
    EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
  }
  Folder folder;
};

TEST(Simulate, RefusesWithOneSentence) {
  const Bench bench;
  bench.refused({"cell.yaml", "--method", "risng"}, "rising");
  bench.refused({"bare.yaml"}, "no robot");
  bench.refused({"cell.yaml", "--robot", "light.urdf"}, "no inertia");
  bench.refused({"cell.yaml", "--step-ms", "50"}, "time step");
  bench.refused({"cell.yaml", "--step-ms", "nan"}, "not a finite number");
  bench.refused({"cell.yaml", "--delays", "0,-5"}, "delay");
  bench.refused({"cell.yaml", "--tasks", "gantry.urdf"}, "gantry.urdf");
  bench.refused({}, "no scene");
  bench.refused({"nowhere.yaml"}, "nowhere.yaml");
}

TEST(Simulate, AStudyOfOnesOwnIsTheSameOnOneAndTwoThreadsAndReplays) {
  const Bench bench;
  const std::vector<std::string> arguments = {"cell.yaml",   "--tasks",  "tasks.yaml", "--method",
                                              "none,rising", "--delays", "50"};
  auto with = [&](const std::string& threads) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"--threads", threads});
    return bench.run(all);
  };
  const Answer answer = with("1");
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.err, "");
  EXPECT_THAT(answer.out, AllOf(HasSubstr("rising"), HasSubstr("touched")));
  const std::string trials = text_of(bench.folder / "s/trials.csv");
  EXPECT_THAT(text_of(bench.folder / "s/index.html"), HasSubstr("Jones &amp; Hunter 1993 (0.34)"));
  ASSERT_EQ(with("2").code, 0);
  EXPECT_EQ(text_of(bench.folder / "s/trials.csv"), trials);

  const auto study = nlohmann::json::parse(text_of(bench.folder / "s/study.json"));
  EXPECT_EQ(study["trials"], 3);
  const Answer replay =
      bench.folder.run({"replay", "s/field.vicinity", "--robot", "gantry.urdf", "--trajectory",
                        "s/recordings/down_rising.csv", "-o", "felt.csv"});
  EXPECT_EQ(replay.code, 0) << replay.err;
  EXPECT_THAT(text_of(bench.folder / "felt.csv"), HasSubstr("tau_z"));
}

#endif

}  // namespace
}  // namespace vicinity::cli_test
