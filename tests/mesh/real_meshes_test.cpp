// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Every mesh that others made and we can lay hands on: what must come of each. Triangles, and where
// they are given the other counts too, are those of the SOURCES.md beside the files, which were
// taken with other programs. They differ in one place only: Spider_binary.stl is said to hold 36
// duplicates; all of those are copies of triangles that repeat a corner, which we call degenerate.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh_data.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/inspection.h"
#include "vicinity/mesh/mesh_file.h"

namespace vicinity {
namespace {

struct Readable {
  const char* path;
  std::size_t triangles;
  bool closed;
  std::size_t shells, open, cracks, non_manifold, inconsistent, duplicate, degenerate;
};

// clang-format off
constexpr Readable readable[] = {
    // path, triangles, closed, shells, open edges, of these cracks, non-manifold, inconsistent, duplicate, degenerate
    {"meshes/broken/LRO_35.stl", 8130, false, 91, 1164, 620, 48, 26, 0, 0},
    {"meshes/broken/Spider_binary.stl", 1368, false, 18, 72, 0, 0, 10, 0, 56},
    {"meshes/broken/angle_block.STL", 704, false, 1, 166, 166, 0, 0, 0, 0},
    {"meshes/broken/confusingheader_bin.stl", 4, true, 1, 0, 0, 0, 0, 0, 0},
    {"meshes/broken/featuretype.STL", 3476, false, 1, 576, 576, 0, 0, 0, 0},
    {"meshes/broken/multibody.stl", 32, true, 2, 0, 0, 0, 12, 0, 0},
    {"meshes/broken/numpy-stl_ascii_Cube.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"meshes/broken/openscad-nonmanifold-crash.obj", 1442, true, 1, 0, 0, 18, 0, 3, 1},
    {"meshes/broken/soup.stl", 100, false, 100, 300, 0, 0, 0, 0, 0},
    {"meshes/broken/sphereWithHole.stl", 285, false, 1, 9, 0, 0, 0, 0, 0},
    {"meshes/cad/featuretype.3MF", 2208, false, 1, 18, 0, 0, 0, 0, 0},
    {"meshes/clean/004_sugar_box_textured.obj", 16384, true, 1, 0, 0, 0, 0, 0, 0},
    {"meshes/clean/1002_tray_bottom.STL", 4520, true, 1, 0, 0, 0, 0, 0, 0},
    {"meshes/clean/F4.stl", 10032, true, 1, 0, 0, 0, 0, 0, 0},
    {"meshes/clean/Plato.stl", 17064, true, 1, 0, 0, 0, 0, 0, 0},
    {"meshes/clean/complex_bin.stl", 30476, true, 1, 0, 0, 0, 0, 0, 0},
    {"meshes/clean/original_fbx/Plato.fbx", 17064, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/collision/base_link.stl", 412, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/collision/link_1.stl", 902, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/collision/link_2.stl", 1464, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/collision/link_3.stl", 1060, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/collision/link_4.stl", 1554, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/collision/link_5.stl", 1166, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/collision/link_6.stl", 376, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/visual/base_link.stl", 412, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/visual/link_1.stl", 902, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/visual/link_2.stl", 1464, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/visual/link_3.stl", 1060, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/visual/link_4.stl", 1554, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/visual/link_5.stl", 1166, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes/visual/link_6.stl", 376, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/meshes/base_link.STL", 3676, true, 15, 0, 0, 2, 0, 0, 0},
    {"robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/meshes/bracelet_no_vision_link.STL", 26686, false, 5, 148, 148, 0, 0, 0, 0},
    {"robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/meshes/forearm_link.STL", 9124, false, 6, 108, 108, 0, 0, 0, 0},
    {"robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/meshes/half_arm_1_link.STL", 10282, false, 6, 44, 44, 0, 0, 0, 0},
    {"robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/meshes/half_arm_2_link.STL", 9782, false, 4, 144, 144, 0, 0, 0, 0},
    {"robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/meshes/shoulder_link.STL", 9538, false, 4, 80, 80, 0, 0, 0, 0},
    {"robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/meshes/spherical_wrist_1_link.STL", 10928, false, 4, 104, 104, 0, 0, 0, 0},
    {"robots/kinova_gen3_7dof/kortex_description/arms/gen3/7dof/meshes/spherical_wrist_2_link.STL", 10338, true, 4, 0, 0, 0, 0, 0, 0},
    {"robots/phantom_omni/omni_description/meshes/base.stl", 2848, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/phantom_omni/omni_description/meshes/lower_arm.stl", 4994, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/phantom_omni/omni_description/meshes/pen.stl", 3420, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/phantom_omni/omni_description/meshes/tip.stl", 7694, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/phantom_omni/omni_description/meshes/torso.stl", 5676, true, 1, 0, 0, 0, 0, 0, 0},
    {"robots/phantom_omni/omni_description/meshes/upper_arm.stl", 5670, false, 1, 56, 56, 0, 0, 0, 0},
    {"robots/phantom_omni/omni_description/meshes/wrist.stl", 7318, false, 1, 20, 20, 0, 0, 0, 0},
    {"scenes/ariac_workcell/derived_stl/agv_path__path.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/derived_stl/conveyor_belt__conveyor.stl", 1532, false, 22, 64, 0, 0, 0, 0, 82},
    {"scenes/ariac_workcell/derived_stl/conveyor_belt__conveyor_nobase.stl", 1408, false, 21, 64, 0, 0, 0, 0, 82},
    {"scenes/ariac_workcell/derived_stl/floor__floor.stl", 24, true, 1, 0, 0, 18, 0, 12, 0},
    {"scenes/ariac_workcell/derived_stl/warehouse__warehouse.stl", 224, true, 1, 0, 0, 168, 0, 112, 0},
    {"scenes/ariac_workcell/models/agv_path/meshes/path.dae", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/battery_contact.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/hardware.stl", 1204, true, 11, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/insert_base.stl", 928, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/insert_collision.stl", 3956, true, 3, 0, 0, 0, 0, 0, 15},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/mounts.stl", 1656, true, 4, 0, 0, 27, 0, 6, 6},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/pipe_1.stl", 1248, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/pipe_2.stl", 1728, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/pump_contact.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/regulator_contact.stl", 92, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/screen.stl", 452, true, 1, 0, 0, 0, 0, 0, 22},
    {"scenes/ariac_workcell/models/assembly_insert/meshes/sensor_contact.stl", 92, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_table/meshes/assembly_table_collision.stl", 204, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_table/meshes/leg1.stl", 92, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_table/meshes/leg2.stl", 92, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_table/meshes/leg3.stl", 92, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_table/meshes/leg4.stl", 92, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_table/meshes/table_top.stl", 204, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/assembly_table/meshes/tape_outline.stl", 32, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/battery/meshes/battery_base.stl", 36, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/battery/meshes/battery_cap.stl", 36, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/battery/meshes/battery_collision.stl", 108, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/battery/meshes/battery_pins.stl", 36, true, 3, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/conveyor_belt/meshes/conveyor.dae", 1532, false, 22, 64, 0, 0, 0, 0, 82},
    {"scenes/ariac_workcell/models/conveyor_belt/meshes/conveyor.stl", 3396, false, 100, 496, 0, 0, 0, 0, 146},
    {"scenes/ariac_workcell/models/conveyor_belt/meshes/conveyor_nobase.dae", 1408, false, 21, 64, 0, 0, 0, 0, 82},
    {"scenes/ariac_workcell/models/disposal_bin/meshes/disposal_bin.stl", 1376, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/floor/meshes/floor.dae", 24, true, 1, 0, 0, 18, 0, 12, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_00.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_01.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_02.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_03.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_04.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_05.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_06.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_07.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_08.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/markers/marker_09.dae", 56, true, 1, 0, 0, 38, 0, 20, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/tape.stl", 48, true, 4, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/kit_tray/meshes/tray_base.stl", 108, true, 1, 0, 0, 0, 0, 0, 3},
    {"scenes/ariac_workcell/models/kit_tray/meshes/tray_collision.stl", 28, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/kit_tray_table/meshes/kit_tray_table.dae", 1832, true, 1, 0, 0, 1374, 0, 916, 16},
    {"scenes/ariac_workcell/models/kit_tray_table/meshes/kit_tray_table.stl", 774, false, 1, 40, 0, 0, 52, 0, 6},
    {"scenes/ariac_workcell/models/kit_tray_table/meshes/table_collision.stl", 712, false, 1, 40, 0, 0, 53, 0, 0},
    {"scenes/ariac_workcell/models/kit_tray_table/meshes/tool_changer_1.stl", 716, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/kit_tray_table/meshes/tool_changer_2.stl", 716, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/parts_bin/meshes/bin_exterior.dae", 392, true, 1, 0, 0, 294, 0, 196, 0},
    {"scenes/ariac_workcell/models/parts_bin/meshes/bin_exterior.stl", 196, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/parts_bin/meshes/bin_interior.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/pump/meshes/pump_back_pane.stl", 112, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/pump/meshes/pump_base.stl", 1344, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/pump/meshes/pump_bottom_pane.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/pump/meshes/pump_collision.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/pump/meshes/pump_enclosure.stl", 96, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/pump/meshes/pump_front_pane.stl", 112, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/pump/meshes/pump_left_pane.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/pump/meshes/pump_right_pane.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/pump/meshes/pump_top_pane.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/regulator/meshes/regulator_base.stl", 48, true, 1, 0, 0, 0, 0, 0, 1},
    {"scenes/ariac_workcell/models/regulator/meshes/regulator_collision.stl", 528, true, 1, 0, 0, 0, 0, 0, 1},
    {"scenes/ariac_workcell/models/regulator/meshes/regulator_long_peg.stl", 236, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/regulator/meshes/regulator_short_peg.stl", 236, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/sensor/meshes/sensor_base.stl", 102, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/sensor/meshes/sensor_collision.stl", 342, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/sensor/meshes/sensor_peg.stl", 236, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/warehouse/meshes/roof.stl", 12, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/warehouse/meshes/tape.stl", 32, true, 1, 0, 0, 0, 0, 0, 0},
    {"scenes/ariac_workcell/models/warehouse/meshes/warehouse.dae", 224, true, 1, 0, 0, 168, 0, 112, 0},
};
// clang-format on

struct Unreadable {
  const char* path;
  const char* says;
};

constexpr Unreadable unreadable[] = {
    {"meshes/broken/16bit_vs_32bit_should_fail.stl",
     "a count of 1717960706 triangles in 184 bytes"},
    {"meshes/broken/invalid_short.stl", "cut short within its header; found 70 bytes"},
    {"meshes/broken/stl_empty_ascii.stl", "the mesh holds no triangle"},
    {"meshes/cad/featuretype.STEP", "exporting STL from the CAD program"},
};

#define NEEDS_DATA(folder)           \
  const auto folder = data_folder(); \
  if (folder.empty())                \
  GTEST_SKIP() << "VICINITY_DATA does not name a folder of real meshes on this machine"

TEST(RealMeshes, EachComesWithTheExpectedFindings) {
  NEEDS_DATA(data);
  for (const Readable& expected : readable) {
    SCOPED_TRACE(expected.path);
    const MeshInspection found = inspect(read_mesh(data / expected.path));
    EXPECT_EQ(found.triangles, expected.triangles);
    EXPECT_EQ(found.closed, expected.closed);
    EXPECT_EQ(found.shells, expected.shells);
    EXPECT_EQ(found.open_edges, expected.open);
    EXPECT_EQ(found.crack_edges, expected.cracks);
    EXPECT_EQ(found.non_manifold_edges, expected.non_manifold);
    EXPECT_EQ(found.inconsistent_edges, expected.inconsistent);
    EXPECT_EQ(found.duplicate_triangles, expected.duplicate);
    EXPECT_EQ(found.degenerate_triangles, expected.degenerate);
    const bool clean = expected.open + expected.non_manifold + expected.inconsistent +
                           expected.duplicate + expected.degenerate ==
                       0;
    EXPECT_STREQ(to_string(found.verdict), clean ? "ok" : "usable");
    EXPECT_EQ(found.problems.empty(), clean);
  }
}

TEST(RealMeshes, EachThatCannotBeReadIsRefusedWithItsReason) {
  NEEDS_DATA(data);
  for (const auto& [path, says] : unreadable) {
    SCOPED_TRACE(path);
    try {
      read_mesh(data / path);
      FAIL() << "was read";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(says));
      EXPECT_THAT(error.what(), ::testing::HasSubstr(path));
    }
  }
}

TEST(RealMeshes, NoneIsMissingFromTheTables) {
  NEEDS_DATA(data);
  std::set<std::string> known;
  for (const Readable& mesh : readable) known.insert(mesh.path);
  for (const Unreadable& mesh : unreadable) known.insert(mesh.path);
  for (const char* folder : {"meshes", "scenes/ariac_workcell", "robots"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data / folder)) {
      std::string kind = entry.path().extension().string();
      std::transform(kind.begin(), kind.end(), kind.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      const bool mesh = kind == ".stl" || kind == ".dae" || kind == ".obj" || kind == ".3mf" ||
                        kind == ".fbx" || kind == ".step";
      if (!mesh) continue;
      EXPECT_TRUE(known.count(std::filesystem::relative(entry.path(), data).string()))
          << entry.path();
    }
  }
}

/// The same counts the slow way: maps and sets over coordinates, no vertex numbers.
TEST(RealMeshes, FindingsAgreeWithACountOverMaps) {
  NEEDS_DATA(data);
  using Point = std::array<double, 3>;
  for (const Readable& expected : readable) {
    SCOPED_TRACE(expected.path);
    const TriangleMesh mesh = read_mesh(data / expected.path);
    std::map<std::pair<Point, Point>, std::array<int, 2>> edges;
    std::map<std::set<Point>, int> sets;
    for (const auto& t : mesh.triangles) {
      std::array<Point, 3> p;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& v = mesh.vertices[t[i]];
        p[i] = {v.x(), v.y(), v.z()};
      }
      const std::set<Point> corners(p.begin(), p.end());
      if (corners.size() < 3) continue;
      ++sets[corners];
      for (std::size_t i = 0; i < 3; ++i) {
        const Point &a = p[i], &b = p[(i + 1) % 3];
        ++edges[std::minmax(a, b)][a < b];
      }
    }
    std::size_t open = 0, non_manifold = 0, inconsistent = 0, copies = 0;
    for (const auto& [edge, ways] : edges) {
      const int sum = ways[0] + ways[1];
      open += sum == 1;
      non_manifold += sum > 2;
      inconsistent += sum == 2 && ways[0] != 1;
    }
    for (const auto& [corners, count] : sets) copies += static_cast<std::size_t>(count - 1);
    EXPECT_EQ(open, expected.open);
    EXPECT_EQ(non_manifold, expected.non_manifold);
    EXPECT_EQ(inconsistent, expected.inconsistent);
    EXPECT_EQ(copies, expected.duplicate);
  }
}

TEST(RealMeshes, CollisionAndVisualFilesOfTheSameBytesGiveTheSameMesh) {
  NEEDS_DATA(data);
  const auto meshes = data / "robots/fanuc_m10ia/moveit_resources_fanuc_description/meshes";
  for (const char* link : {"base_link.stl", "link_3.stl"}) {
    const TriangleMesh a = read_mesh(meshes / "collision" / link);
    const TriangleMesh b = read_mesh(meshes / "visual" / link);
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.triangles, b.triangles);
  }
}

TEST(RealMeshes, ColladaComesAsTheStlThatOthersDerivedFromIt) {
  NEEDS_DATA(data);
  const auto cell = data / "scenes/ariac_workcell";
  const std::pair<const char*, const char*> pairs[] = {
      {"models/agv_path/meshes/path.dae", "agv_path__path.stl"},
      {"models/conveyor_belt/meshes/conveyor.dae", "conveyor_belt__conveyor.stl"},
      {"models/conveyor_belt/meshes/conveyor_nobase.dae", "conveyor_belt__conveyor_nobase.stl"},
      {"models/floor/meshes/floor.dae", "floor__floor.stl"},
      {"models/warehouse/meshes/warehouse.dae", "warehouse__warehouse.stl"},
  };
  for (const auto& [dae, stl] : pairs) {
    SCOPED_TRACE(dae);
    const TriangleMesh ours = read_mesh(cell / dae);
    const TriangleMesh derived = read_mesh(cell / "derived_stl" / stl);
    const double size = derived.bounds().diagonal().norm();
    EXPECT_LT((ours.bounds().min() - derived.bounds().min()).norm(), 1e-6 * size);
    EXPECT_LT((ours.bounds().max() - derived.bounds().max()).norm(), 1e-6 * size);
    EXPECT_NEAR(surface_area(ours) / surface_area(derived), 1, 1e-5);
    EXPECT_NEAR(volume(ours), volume(derived), 1e-5 * size * size * size);
  }
}

TEST(RealMeshes, FbxComesAsTheStlThatOthersDerivedFromIt) {
  NEEDS_DATA(data);
  const TriangleMesh fbx = read_mesh(data / "meshes/clean/original_fbx/Plato.fbx");
  const TriangleMesh stl = read_mesh(data / "meshes/clean/Plato.stl");
  const auto points = [](const TriangleMesh& mesh) {
    std::set<std::array<double, 3>> set;
    for (const Vec3& v : mesh.vertices) set.insert({v.x(), v.y(), v.z()});
    return set;
  };
  EXPECT_EQ(points(fbx), points(stl));
  // Quads may be cut along the other diagonal.
  EXPECT_NEAR(volume(fbx) / volume(stl), 1, 1e-3);
}

TEST(RealMeshes, TwoSidedSheetsAreSaidToEncloseNothing) {
  NEEDS_DATA(data);
  for (const char* sheet : {"floor__floor.stl", "warehouse__warehouse.stl"}) {
    const auto found = inspect(read_mesh(data / "scenes/ariac_workcell/derived_stl" / sheet));
    EXPECT_THAT(found.problems,
                ::testing::Contains(::testing::Field(
                    &MeshProblem::means, ::testing::HasSubstr("nothing will be inside"))));
  }
}

}  // namespace
}  // namespace vicinity
