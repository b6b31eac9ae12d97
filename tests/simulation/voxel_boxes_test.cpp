// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Boxes of the workplace: all solid voxels, each once; and those near an arm.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "simulation/arm_model.h"
#include "simulation/gantry.h"
#include "simulation/voxel_boxes.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

TEST(VoxelBoxes, CoverEverySolidVoxelOnceAndNoOther) {
  Scene scene;
  scene.voxel_size = 0.01;
  scene.objects.push_back({.name = "ring", .shape = primitive::torus(0.08, 0.03)});
  scene.objects.push_back({.name = "cone", .shape = primitive::cone(0.05, 0.1)});
  const ViscosityField field = build_field(scene).field;
  const Workspace& workspace = field.workspace();
  const VoxelBoxes boxes(field, Box(Vec3::Constant(-1), Vec3::Constant(1)));
  ASSERT_GT(boxes.boxes().size(), 10u);
  for (int k = 0; k < workspace.dims.k; ++k) {
    for (int j = 0; j < workspace.dims.j; ++j) {
      for (int i = 0; i < workspace.dims.i; ++i) {
        const Vec3 centre = workspace.centre_of({i, j, k});
        const auto covering = std::count_if(boxes.boxes().begin(), boxes.boxes().end(),
                                            [&](const Box& box) { return box.contains(centre); });
        const VoxelKind kind = field.at(centre).record.kind;
        const bool solid = kind == VoxelKind::boundary || kind == VoxelKind::inner;
        ASSERT_EQ(covering, solid ? 1 : 0) << i << ' ' << j << ' ' << k;
      }
    }
  }
}

TEST(VoxelBoxes, NearOnesAreThoseThatAPlainLoopFinds) {
  const VoxelBoxes& boxes = *block_workplace().boxes;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-0.3, 0.3);
  std::vector<std::uint32_t> found;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 at(place(random), place(random), place(random));
    boxes.near({{at, at, 0.02}}, 0.03, 100, found);
    std::size_t within = 0;
    for (const Box& box : boxes.boxes()) within += box.exteriorDistance(at) < 0.05 ? 1 : 0;
    ASSERT_EQ(found.size(), within) << at.transpose();
  }
}

TEST(ArmModel, CapsulesOfACylinderAreInItAndReachItsSides) {
  Link link{.name = "tube", .geometries = {{.mesh = primitive::cylinder(0.05, 0.3)}}};
  const auto capsules = capsules_of(link);
  ASSERT_EQ(capsules.size(), 1u);
  EXPECT_NEAR(capsules[0].radius, 0.05, 1e-3);
  EXPECT_NEAR((capsules[0].to - capsules[0].from).norm(), 0.2, 2e-3);
}

TEST(ArmModel, CapsulesOfABoxTouchAllSixFacesFromWithin) {
  Link link{.name = "jaw", .geometries = {{.mesh = primitive::box({0.09, 0.04, 0.06})}}};
  Box around;
  for (const Capsule& capsule : capsules_of(link)) {
    const Vec3 r = Vec3::Constant(capsule.radius);
    around.extend(
        Box(capsule.from.cwiseMin(capsule.to) - r, capsule.from.cwiseMax(capsule.to) + r));
  }
  EXPECT_LT((around.sizes() - Vec3(0.09, 0.04, 0.06)).norm(), 1e-12);
}

}  // namespace
}  // namespace vicinity
