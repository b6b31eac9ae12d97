// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Verdicts on voxels, and the report's own probe vectors beside the library's.

#include <gtest/gtest.h>

#include "bench_room.h"
#include "reproduce/parts.h"
#include "reproduce/voxelisation.h"
#include "vicinity/voxel/boundary.h"

namespace vicinity::report {
namespace {

TEST(Fig9, TurnsForALidThatIsHollowAndForABodyThatIsNotFilled) {
  const BodySection top{.z = 60, .boundary = 1300, .inner = 0, .closed = true, .true_area = 1256};
  const BodySection middle{
      .z = 40, .boundary = 160, .inner = 1176, .closed = true, .true_area = 1256};
  EXPECT_TRUE(agrees(check_fig9(top, middle))) << why(check_fig9(top, middle));
  EXPECT_FALSE(agrees(check_fig9(middle, middle)));
  BodySection unfilled = middle;
  unfilled.inner = 0;
  EXPECT_FALSE(agrees(check_fig9(top, unfilled)));
  BodySection open = middle;
  open.closed = false;
  EXPECT_FALSE(agrees(check_fig9(top, open)));
}

TEST(Fig9, ASkinWithoutItsInsideIsNoBody) {
  const BenchRoom room;
  const Layers skin{.m = 1, .q = 0, .inner = InnerMethod::none};
  const ViscosityField field = room.workshop().field(circular_cylinder(), skin);
  const BodySection top = body_section(field, 60, 1256), middle = body_section(field, 40, 1256);
  EXPECT_FALSE(agrees(check_fig9(top, middle)));
}

TEST(Fig12To14, TurnForVolumesWidthsAndGapsThatAreOff) {
  EXPECT_TRUE(agrees(check_fig12({{"cube", 2402, 6859, 8000}})));
  EXPECT_FALSE(agrees(check_fig12({{"cube", 2402, 0, 8000}})));

  const BodySection disc{.z = 5, .boundary = 100, .inner = 1206, .closed = true, .true_area = 1256};
  EXPECT_TRUE(agrees(check_fig13({{disc}, {40, 20}, {40.4, 20.1}})));
  EXPECT_FALSE(agrees(check_fig13({{disc}, {40, 25}, {40.4, 20.1}})));

  EXPECT_TRUE(agrees(check_fig14({{35, 0, 0}, {50, 12, 12.1}, {62, 29, 29.3}})));
  EXPECT_FALSE(agrees(check_fig14({{35, 3, 0}, {50, 12, 12.1}, {62, 29, 29.3}})));
  EXPECT_FALSE(agrees(check_fig14({{35, 0, 0}, {50, 12, 12.1}, {62, 12, 29.3}})));
}

TEST(Fig11, AgreesOnlyWhereTheChoiceIsBestOnEveryPart) {
  using enum ProbeLines;
  std::vector<ProbeResult> results{
      {"a", largest_face, 100, 20, 1},  {"a", always_z, 100, 60, 2},
      {"a", smallest_face, 100, 99, 0}, {"b", largest_face, 100, 40, 1},
      {"b", always_z, 100, 45, 2},      {"b", smallest_face, 100, 70, 0}};
  EXPECT_TRUE(agrees(check_fig11(results))) << why(check_fig11(results));
  results[4].missed = 30;
  EXPECT_FALSE(agrees(check_fig11(results)));
}

// Lines that meet the surface on the face between two voxels may name either: hence "almost".
TEST(Fig11, TheReportsProbeVectorsMissAlmostWhatTheLibrarysMiss) {
  const BenchRoom room;
  Workspace workspace;
  workspace.voxel_size = voxel_m;
  for (const Part& part : {cone(), wedge(), ball(), complex_cylinder()}) {
    const TriangleMesh mesh = room.workshop().read_back(part);
    const ProbeResult ours = probe(part.name, mesh, ProbeLines::largest_face);
    const std::size_t exact = boundary_voxels(mesh, workspace).count();
    const std::size_t met = boundary_voxels(mesh, workspace, BoundaryMethod::probe).count();
    EXPECT_EQ(ours.exact, exact) << part.name;
    EXPECT_NEAR(static_cast<double>(ours.exact - ours.missed), static_cast<double>(met),
                1e-3 * static_cast<double>(exact))
        << part.name;
  }
}

}  // namespace
}  // namespace vicinity::report
