// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/placement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "mesh_data.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

TEST(Placement, AUnitIsItsLengthInMetres) {
  EXPECT_EQ(metres_per(*length_unit("mm")), 0.001);
  EXPECT_EQ(metres_per(*length_unit("cm")), 0.01);
  EXPECT_EQ(metres_per(*length_unit("m")), 1.0);
  for (const char* word : {"in", "inch", "inches"}) {
    EXPECT_EQ(metres_per(*length_unit(word)), 0.0254) << word;
  }
}

TEST(Placement, OnlyTheWordsOfAUnitAreAUnit) {
  for (const char* word : {"", "MM", "millimetre", "ft", "m ", "mmm"}) {
    EXPECT_FALSE(length_unit(word)) << word;
  }
}

TEST(Placement, ScalesBeforeItMoves) {
  TriangleMesh mesh{.vertices = {Vec3(1000, 0, 0), Vec3(0, 1000, 0), Vec3(0, 0, 1000)},
                    .triangles = {{0, 1, 2}}};
  const Pose X_WO = pose_from_rpy(Vec3(5, 6, 7), Vec3(0, 0, std::numbers::pi / 2));
  mesh = place(std::move(mesh), 2 * metres_per(LengthUnit::millimetre), X_WO);
  // A quarter turn about z takes x to y and y to -x.
  EXPECT_TRUE(mesh.vertices[0].isApprox(Vec3(5, 8, 7), 1e-15));
  EXPECT_TRUE(mesh.vertices[1].isApprox(Vec3(3, 6, 7), 1e-15));
  EXPECT_TRUE(mesh.vertices[2].isApprox(Vec3(5, 6, 9), 1e-15));
}

TEST(Placement, KeepsVolumeAndWinding) {
  const TriangleMesh cone = primitive::cone(0.3, 0.7);
  const Pose X_WO = pose_from_rpy(Vec3(-3, 2, 1), Vec3(0.4, -1.1, 2.5));
  const TriangleMesh placed = place(cone, 2.0, X_WO);
  EXPECT_NEAR(volume(placed), 8 * volume(cone), 1e-12);
  EXPECT_EQ(placed.triangles, cone.triangles);
}

TEST(Placement, RefusesAScaleThatIsNoFactor) {
  for (const double scale : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(place(primitive::box(Vec3::Ones()), scale, Pose::Identity()), Error) << scale;
  }
}

TEST(Placement, ReadsASizeInThreeUnits) {
  const Box tray(Vec3(0, 0, 0), Vec3(355, 3.175, 355));
  EXPECT_EQ(size_in_units(tray),
            "355 x 3.17 x 355 mm if the unit is mm; 355 x 3.17 x 355 m if m; "
            "9.02 x 0.0806 x 9.02 m if inches");
  EXPECT_EQ(size_in_units(Box()), "nothing");
}

}  // namespace
}  // namespace vicinity
