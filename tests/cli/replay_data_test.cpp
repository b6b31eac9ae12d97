// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity replay with real arms, real joint logs and the ARIAC work cell.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "program.h"

namespace vicinity::cli_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kinova =
    "robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/urdf/"
    "GEN3-7DOF-NOVISION_FOR_URDF_ARM_V12.urdf";
constexpr const char* fanuc =
    "robots/fanuc_m10ia/moveit_resources_fanuc_description/urdf/fanuc.urdf";
constexpr const char* omni = "robots/phantom_omni/omni_description/urdf/omni.urdf";
constexpr const char* logs = "trajectories/kinova_gen3_identification";

// A file or folder of the real data; empty where the tests run without it.
std::filesystem::path data(const std::string& name) {
  const char* folder = std::getenv("VICINITY_DATA");
  if (folder == nullptr) return {};
  const std::filesystem::path path = std::filesystem::path(folder) / name;
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

TEST(ReplayData, CheckOnlyReportsWhatIsOddAboutRealArms) {
  if (data(kinova).empty() || data(fanuc).empty() || data(omni).empty()) {
    GTEST_SKIP() << "no real robots: VICINITY_DATA is not set, or lacks them";
  }
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  ASSERT_EQ(folder.run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
  const auto remarks = [&](const char* robot) {
    const Answer answer =
        folder.run({"replay", "f.vicinity", "--robot", data(robot).string(), "--check-only"});
    EXPECT_EQ(answer.code, 0) << answer.err;
    return answer.out;
  };
  EXPECT_THAT(remarks(kinova), AllOf(HasSubstr("7 joints that move"), HasSubstr("zero axis"),
                                     HasSubstr("no surface"), HasSubstr("no mass"),
                                     HasSubstr("forearm_link.STL: 108 crack edges")));
  EXPECT_THAT(remarks(fanuc), AllOf(HasSubstr("6 joints that move"), HasSubstr("effort limit 0"),
                                    HasSubstr("tool0, base"), HasSubstr("no inertia")));
  EXPECT_THAT(remarks(omni),
              AllOf(HasSubstr("6 joints that move"), HasSubstr("no collision geometry"),
                    HasSubstr("'yaw' cannot be at zero"), HasSubstr("no inertia")));
}

// The arm stands between a parts bin and the conveyor, as docs/replay.md has it.
TEST(ReplayData, BothKinovaLogsRunPastTheConveyorOfTheAriacCell) {
  const std::filesystem::path cell = data("scenes/ariac_workcell");
  if (cell.empty() || data(kinova).empty() || data(logs).empty()) {
    GTEST_SKIP() << "no real logs: VICINITY_DATA is not set, or lacks them";
  }
  const Folder folder;
  const Answer built =
      folder.run({"build", VICINITY_SCENES "/ariac_workcell.yaml", "--meshes", cell.string(), "-o",
                  "bins.vicinity", "--voxel-size", "0.02", "--bounds", "-3.5,1.8,0,-0.9,4.2,2.2"});
  ASSERT_EQ(built.code, 0) << built.err;
  std::string columns = "t=Time*0.001";
  for (int n = 1; n <= 7; ++n) {
    const std::string number = std::to_string(n);
    columns +=
        ",joint_" + number + "=Position" + number + ",qd_joint_" + number + "=Velocity" + number;
  }
  const std::pair<const char*, int> lengths[] = {{"RecordTrajectory_quadratic.csv", 4945},
                                                 {"RunTrajectory1.csv", 1942}};
  for (const auto& [log, samples] : lengths) {
    SCOPED_TRACE(log);
    const Answer answer =
        folder.run({"replay", "bins.vicinity", "--robot", data(kinova).string(), "--base",
                    "-1.35,3.375,0.72,0,0,0", "--exclude", "base_link", "--trajectory",
                    (data(logs) / log).string(), "--columns", columns, "-o", "felt.csv", "--json"});
    ASSERT_EQ(answer.code, 0) << answer.err;
    const auto json = answer.json();
    EXPECT_EQ(json["ticks"], samples);
    EXPECT_EQ(json["statuses"]["started"], 1);
    EXPECT_EQ(json["statuses"]["ok"], samples - 1);
    EXPECT_EQ(json["strongest"]["object"], "conveyor");
    EXPECT_GT(json["energy"]["drag"], 0);
    EXPECT_THAT(text_of(folder / "felt.csv"), HasSubstr(",conveyor,"));
  }
}

}  // namespace
}  // namespace vicinity::cli_test
