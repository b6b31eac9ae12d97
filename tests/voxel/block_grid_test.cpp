// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/block_grid.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vicinity {
namespace {

/// Big enough that chunks of huge pages are among those taken.
struct Marks {
  std::array<std::int32_t, 256> values{};
};

const VoxelBox box{{-640, -80, -160}, {640, 80, 160}};  // 20 x 20 x 40 blocks

std::vector<BlockIndex> all_blocks() {
  std::vector<BlockIndex> blocks;
  for (std::int32_t k = -20; k < 20; ++k) {
    for (std::int32_t j = -10; j < 10; ++j) {
      for (std::int32_t i = -10; i < 10; ++i) blocks.push_back({i, j, k});
    }
  }
  return blocks;
}

std::int32_t mark_of(const BlockIndex& b) { return (b.i * 100 + b.j) * 100 + b.k; }

TEST(BlockGrid, KeepsEveryBlockWhereItIsAlsoWhenMoved) {
  BlockGrid<Marks> grid(box);
  std::vector<const Marks*> places;
  for (const BlockIndex& b : all_blocks()) {
    Marks& made = grid.make(b);
    EXPECT_EQ(made.values, Marks().values);
    made.values.fill(mark_of(b));
    places.push_back(&made);
  }
  const BlockGrid<Marks> moved = std::move(grid);
  EXPECT_EQ(moved.block_count(), places.size());
  std::size_t n = 0;
  for (const BlockIndex& b : all_blocks()) {
    ASSERT_EQ(moved.find(b), places[n++]);
    ASSERT_EQ(moved.find(b)->values.back(), mark_of(b));
  }
}

TEST(BlockGrid, TakesBlocksOfDifferentSlabsFromDifferentThreads) {
  BlockGrid<Marks> grid(box);
  tbb::parallel_for(-20, 20, [&](std::int32_t k) {
    for (const BlockIndex& b : all_blocks()) {
      if (b.k == k) grid.make(b).values.fill(mark_of(b));
    }
  });
  EXPECT_EQ(grid.block_count(), all_blocks().size());
  for (const BlockIndex& b : all_blocks()) {
    for (const std::int32_t value : grid.find(b)->values) ASSERT_EQ(value, mark_of(b));
  }
}

TEST(BlockGrid, CopiesHaveBlocksOfTheirOwn) {
  BlockGrid<Marks> grid(box);
  grid.make({1, 2, 3}).values.fill(7);
  BlockGrid<Marks> copy = grid;
  copy.make({1, 2, 3}).values.fill(8);
  copy.make({1, 2, 4}).values.fill(9);
  EXPECT_EQ(grid.block_count(), 1u);
  EXPECT_EQ(grid.find({1, 2, 3})->values.front(), 7);
  EXPECT_EQ(grid.find({1, 2, 4}), nullptr);
  grid = copy;
  EXPECT_EQ(grid.block_count(), 2u);
  EXPECT_EQ(grid.find({1, 2, 4})->values.front(), 9);
  EXPECT_NE(grid.find({1, 2, 4}), copy.find({1, 2, 4}));
}

TEST(BlockGrid, HoldsNothingInAnEmptyBox) {
  const BlockGrid<Marks> grid;
  EXPECT_EQ(grid.block_count(), 0u);
  EXPECT_EQ(grid.find({0, 0, 0}), nullptr);
  const BlockGrid<Marks> copy = grid;
  EXPECT_EQ(copy.block_count(), 0u);
}

}  // namespace
}  // namespace vicinity
