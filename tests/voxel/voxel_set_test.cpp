// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/voxel_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "sets.h"

namespace vicinity {
namespace {

TEST(VoxelSet, HoldsWhatWasPutInAlsoBelowZero) {
  VoxelSet set({{-130, -20, -9}, {70, 5, 12}});
  const std::vector<VoxelIndex> voxels{{-130, -20, -9}, {-129, -20, -9}, {-1, -1, -1}, {0, 0, 0},
                                       {63, 4, 11},     {64, 4, 11},     {69, 4, 11}};
  for (const VoxelIndex& v : voxels) set.insert(v);
  for (const VoxelIndex& v : voxels) {
    EXPECT_TRUE(set.contains(v)) << testing::PrintToString(v);
    EXPECT_NE(set.word(v.i >> 6, v.j, v.k) >> (v.i & 63) & 1, 0u);
  }
  EXPECT_EQ(set.count(), voxels.size());
  EXPECT_FALSE(set.contains({-128, -20, -9}));
  EXPECT_FALSE(set.contains({-131, -20, -9}));
  EXPECT_FALSE(set.contains({1000, 0, 0}));
  EXPECT_EQ(set.word(-99, 0, 0), 0u);
}

TEST(VoxelSet, CutsARunAtItsBox) {
  VoxelSet set({{-70, 0, 0}, {130, 2, 2}});
  set.insert_run(-1000, 1000, 1, 1);
  set.insert_run(5, 5, 0, 0);
  set.insert_run(9, 3, 0, 0);
  set.insert_run(0, 9, 2, 0);
  set.insert_run(0, 9, 0, -1);
  EXPECT_EQ(set.count(), 200u);
  EXPECT_TRUE(set.contains({-70, 1, 1}));
  EXPECT_TRUE(set.contains({129, 1, 1}));
}

TEST(VoxelSet, VisitsEveryVoxelOnce) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::int32_t> index(-100, 100), length(1, 150);
    VoxelSet set({{-100, -100, -100}, {101, 101, 101}});
    std::set<std::tuple<int, int, int>> expected;
    for (int n = 0; n < 200; ++n) {
      const VoxelIndex v{index(random), index(random), index(random)};
      const std::int32_t end = std::min(v.i + length(random), 101);
      set.insert_run(v.i, end, v.j, v.k);
      for (std::int32_t i = v.i; i < end; ++i) expected.insert({i, v.j, v.k});
    }
    EXPECT_EQ(triples(set), expected);
    EXPECT_EQ(set.count(), expected.size());
  }
}

TEST(VoxelSet, IsEmptyWithoutABox) {
  const VoxelSet set;
  EXPECT_EQ(set.count(), 0u);
  EXPECT_FALSE(set.contains({0, 0, 0}));
}

TEST(BlockGrid, StoresOnlyWhatWasMade) {
  BlockGrid<BitBlock> grid({{-64, -8, -8}, {640, 80, 80}});
  EXPECT_EQ(grid.lo(), (BlockIndex{-1, -1, -1}));
  EXPECT_EQ(grid.size(), (BlockIndex{11, 11, 11}));
  EXPECT_EQ(grid.block_count(), 0u);
  grid.make({9, 9, 9}).words[3] = 7;
  grid.make({-1, -1, -1});
  EXPECT_EQ(grid.make({9, 9, 9}).words[3], 7u);
  EXPECT_EQ(grid.block_count(), 2u);
  EXPECT_EQ(grid.find({9, 9, 9})->words[3], 7u);
  EXPECT_EQ(grid.find({0, 0, 0}), nullptr);
  EXPECT_EQ(grid.find({10, 0, 0}), nullptr);
  EXPECT_EQ(grid.find({0, 0, -2}), nullptr);
  std::vector<BlockIndex> visited;
  grid.for_each([&](const BlockIndex& b, const BitBlock&) { visited.push_back(b); });
  EXPECT_EQ(visited, (std::vector<BlockIndex>{{-1, -1, -1}, {9, 9, 9}}));
}

}  // namespace
}  // namespace vicinity
