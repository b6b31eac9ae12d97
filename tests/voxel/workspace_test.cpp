// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/workspace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "vicinity/geometry/error.h"
#include "vicinity/voxel/voxel.h"

namespace vicinity {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Workspace, CoversBoundsWithTheFewestVoxels) {
  const Workspace exact = Workspace::covering({Vec3(0, 0, 0), Vec3(1, 2, 0.5)}, 0.25);
  EXPECT_EQ(exact.dims, (VoxelIndex{4, 8, 2}));
  const Workspace more = Workspace::covering({Vec3(0, 0, 0), Vec3(1.01, 2, 0.5)}, 0.25);
  EXPECT_EQ(more.dims, (VoxelIndex{5, 8, 2}));
}

TEST(Workspace, AddsNoVoxelForARoundingError) {
  // 0.3 / 0.1 is slightly more than three in binary.
  const Workspace workspace = Workspace::covering({Vec3(0, 0, 0), Vec3(0.3, 0.3, 0.3)}, 0.1);
  EXPECT_EQ(workspace.dims, (VoxelIndex{3, 3, 3}));
}

TEST(Workspace, HasAVoxelEvenWhereTheBoundsAreFlat) {
  EXPECT_EQ(Workspace::covering({Vec3(0, 0, 0), Vec3(1, 1, 0)}, 0.5).dims, (VoxelIndex{2, 2, 1}));
}

TEST(Workspace, HoldsHalfOpenVoxels) {
  const Workspace workspace{Vec3(-1, 0, 2), 0.5, {8, 8, 8}};
  EXPECT_EQ(workspace.index_of({-1, 0, 2}), (VoxelIndex{0, 0, 0}));
  EXPECT_EQ(workspace.index_of({-0.5, 0.499, 2.5}), (VoxelIndex{1, 0, 1}));
  EXPECT_EQ(workspace.index_of({-1.001, -0.5, 1.9}), (VoxelIndex{-1, -1, -1}));
  EXPECT_EQ(workspace.centre_of({1, 0, -1}), Vec3(-0.25, 0.25, 1.75));
}

TEST(Workspace, FindsEachCentreInItsOwnVoxel) {
  const Workspace workspace{Vec3(0.1, -0.7, 3.3), 0.005, {100, 100, 100}};
  for (std::int32_t n = -50; n < 150; ++n) {
    const VoxelIndex v{n, -2 * n, 3 * n};
    EXPECT_EQ(workspace.index_of(workspace.centre_of(v)), v);
  }
}

TEST(Workspace, RefusesWhatIsNotAGrid) {
  const Box unit(Vec3(0, 0, 0), Vec3(1, 1, 1));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double size : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT([&] { Workspace::covering(unit, size); },
                ThrowsMessage<Error>(HasSubstr("voxel_size")));
  }
  EXPECT_THAT([&] { Workspace::covering({}, 0.1); }, ThrowsMessage<Error>(HasSubstr("bounds")));
  EXPECT_THAT(
      [&] {
        Workspace::covering({Vec3(0, 0, 0), Vec3(1, nan, 1)}, 0.1);
      },
      ThrowsMessage<Error>(HasSubstr("bounds")));
  EXPECT_THAT([&] { Workspace::covering(unit, 1e-7); },
              ThrowsMessage<Error>(HasSubstr("too small")));
}

TEST(VoxelBox, GrowsAndHoldsItsLowerCornerOnly) {
  const VoxelBox box{{-1, 0, 1}, {2, 2, 2}};
  EXPECT_TRUE(box.contains({-1, 0, 1}));
  EXPECT_FALSE(box.contains({2, 1, 1}));
  EXPECT_FALSE(box.contains({0, 0, 2}));
  EXPECT_EQ(box.grown(2), (VoxelBox{{-3, -2, -1}, {4, 4, 4}}));
  EXPECT_TRUE(VoxelBox{}.empty());
  EXPECT_TRUE((VoxelBox{{0, 0, 0}, {5, 0, 5}}.empty()));
}

TEST(VoxelKind, IsNamedAsInThePaper) {
  EXPECT_STREQ(to_string(VoxelKind::empty), "empty");
  EXPECT_STREQ(to_string(VoxelKind::neighbour), "neighbour");
  EXPECT_STREQ(to_string(VoxelKind::inner), "inner");
  EXPECT_STREQ(to_string(VoxelKind::boundary), "boundary");
}

}  // namespace
}  // namespace vicinity
