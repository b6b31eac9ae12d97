// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Objects larger than a tile, held against the same object voxelised and ranked whole.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "rounds.h"
#include "seeds.h"
#include "vicinity/layers/ranked_neighbours.h"
#include "vicinity/mesh/placement.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

using test::for_each_seed;
using test::real;
using test::whole;

/// Reads voxels of the field at random places near the object, and at every tile border.
class Samples {
 public:
  Samples(std::mt19937& random, const VoxelIndex& dims) : random_(random), dims_(dims) {}

  VoxelIndex next() {
    const auto along = [&](std::int32_t dim) {
      if (whole(random_, 0, 1) == 0) return whole(random_, 0, dim - 1);
      const int border = 256 * whole(random_, 0, dim / 256) + whole(random_, -30, 30);
      return std::clamp(border, 0, dim - 1);
    };
    return {along(dims_.i), along(dims_.j), along(dims_.k)};
  }

 private:
  std::mt19937& random_;
  VoxelIndex dims_;
};

/// Whether the field of one object is what the object is when it is ranked as a whole.
void expect_as_ranked_whole(std::mt19937& random, const SceneObject& object, int samples) {
  Scene scene;
  scene.voxel_size = 1;
  scene.objects = {object};
  const ViscosityField field = build_field(scene).field;
  const auto& mesh = std::get<TriangleMesh>(object.shape);
  const VoxelSet boundary = boundary_voxels(mesh, field.workspace());
  const VoxelSet inner = inner_voxels(mesh, boundary, field.workspace());
  const RankedNeighbours layers =
      ranked_neighbours(boundary, inner, ShapingElement(object.layers, object.m), object.q);

  const FieldObject& described = field.objects()[0];
  EXPECT_EQ(described.boundary, boundary.count());
  EXPECT_EQ(described.inner, inner.count());
  EXPECT_EQ(field.voxel_counts().boundary, boundary.count());
  EXPECT_EQ(field.voxel_counts().inner, inner.count());
  for (std::size_t n = 0; n < layers.ranks.size(); ++n)
    EXPECT_EQ(described.ranks[n], layers.ranks[n].count()) << "rank " << n + 1;

  Samples places(random, field.workspace().dims);
  int wrong = 0, ranked = 0;
  for (int s = 0; s < samples; ++s) {
    const VoxelIndex v = places.next();
    VoxelRecord expected;
    if (boundary.contains(v)) expected.kind = VoxelKind::boundary;
    if (inner.contains(v)) expected.kind = VoxelKind::inner;
    for (std::size_t n = 0; n < layers.ranks.size(); ++n) {
      if (!layers.ranks[n].contains(v)) continue;
      expected = {VoxelKind::neighbour, static_cast<std::uint8_t>(n + 1), 0};
      ++ranked;
    }
    const VoxelRecord& record = field.records()[field.code_at(v)];
    wrong += record.kind != expected.kind || record.rank != expected.rank;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(ranked, 0) << "no sample met a layer";
}

SceneObject ranked_object(TriangleMesh mesh, LayerShape shape, int m, int q) {
  SceneObject object;
  object.name = "large";
  object.shape = std::move(mesh);
  object.layers = shape;
  object.m = m;
  object.q = q;
  object.coding.mu.assign(static_cast<std::size_t>(q), 10);
  return object;
}

TEST(Tiles, AnObjectAcrossTilesIsRankedAsIfItWereWhole) {
  for_each_seed(test::rounds(4), [](std::mt19937& random) {
    TriangleMesh mesh = whole(random, 0, 1) == 0 ? primitive::torus(210, real(random, 20, 60), 48)
                                                 : primitive::box({700, 40, 300});
    const Pose pose =
        pose_from_rpy(Vec3(real(random, -90, 90), real(random, -90, 90), real(random, -90, 90)),
                      Vec3(real(random, -3, 3), real(random, -0.3, 0.3), real(random, -0.3, 0.3)));
    const int m = whole(random, 1, 8);
    const auto shape = whole(random, 0, 1) == 0 ? LayerShape::sphere : LayerShape::cube;
    expect_as_ranked_whole(
        random, ranked_object(place(mesh, 1, pose), shape, m, whole(random, 1, 6)), 200'000);
  });
}

// Most tiles of a plate along the grid are alike: what is taken over from one must fit the others.
TEST(Tiles, EqualTilesAreEqualWhereverTheyStand) {
  std::mt19937 random(1);
  const TriangleMesh plate = primitive::box({1500, 1100, 3.5});
  expect_as_ranked_whole(random, ranked_object(plate, LayerShape::sphere, 4, 6), 200'000);
}

// A tile in the middle of a solid sees no surface at all.
TEST(Tiles, ASolidLargerThanATileIsInnerThroughout) {
  std::mt19937 random(1);
  const TriangleMesh block = primitive::box({900, 620, 640});
  expect_as_ranked_whole(random, ranked_object(block, LayerShape::cube, 2, 3), 200'000);
}

}  // namespace
}  // namespace vicinity
