// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/layers/ranked_neighbours.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "layers/triple_loop.h"
#include "rounds.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

/// Every voxel of the oracle's array has the same rank in `layers`, and nothing lies outside it.
void expect_as_the_triple_loop(const RankedNeighbours& layers, const VoxelSet& boundary,
                               const VoxelSet& inner, LayerShape shape, int m, int q) {
  triple_loop::ObjectVoxelArray ova = triple_loop::ranked_neighbours(boundary, inner, shape, m, q);
  ASSERT_EQ(layers.ranks.size(), static_cast<std::size_t>(q));
  std::size_t differing = 0;
  std::vector<std::size_t> counts(static_cast<std::size_t>(q) + 1, 0);
  for (const std::int16_t type : ova.type) {
    if (type > 0) ++counts[static_cast<std::size_t>(type)];
  }
  for (int n = 1; n <= q; ++n) {
    const VoxelSet& rank = layers.ranks[static_cast<std::size_t>(n - 1)];
    EXPECT_EQ(rank.box(), ova.box);
    rank.for_each([&](const VoxelIndex& v) {
      if (!ova.box.contains(v) || ova.at(v.i, v.j, v.k) != n) ++differing;
    });
    EXPECT_EQ(rank.count(), counts[static_cast<std::size_t>(n)]) << "rank " << n;
  }
  EXPECT_EQ(differing, 0u);
}

/// A random object: clutter of solid balls and bricks with or without a skin, plates one voxel
/// thick, stray voxels, and inner voxels that touch empty ones.
struct RandomObject {
  VoxelSet boundary, inner;
};

RandomObject random_object(std::mt19937& random, int largest) {
  const auto pick = [&](int lo, int hi) { return std::uniform_int_distribution(lo, hi)(random); };
  const VoxelIndex lo{pick(-150, 100), pick(-40, 40), pick(-40, 40)};
  const VoxelIndex size{pick(1, pick(0, 2) == 0 ? 3 * largest : largest), pick(1, largest),
                        pick(1, largest)};
  const VoxelBox box{lo, {lo.i + size.i, lo.j + size.j, lo.k + size.k}};
  RandomObject object{VoxelSet(box), VoxelSet(box)};
  const auto inside = [&] {
    return VoxelIndex{pick(lo.i, box.hi.i - 1), pick(lo.j, box.hi.j - 1), pick(lo.k, box.hi.k - 1)};
  };
  const auto for_box = [&](const auto& visit) {
    for (int k = lo.k; k < box.hi.k; ++k) {
      for (int j = lo.j; j < box.hi.j; ++j) {
        for (int i = lo.i; i < box.hi.i; ++i) visit(VoxelIndex{i, j, k});
      }
    }
  };
  for (int part = pick(1, 4); part > 0; --part) {
    const VoxelIndex c = inside();
    const int radius = pick(0, largest / 2);
    switch (pick(0, 5)) {
      case 0:  // a ball with a skin
        for_box([&](const VoxelIndex& v) {
          const int i = v.i - c.i, j = v.j - c.j, k = v.k - c.k;
          const int d2 = i * i + j * j + k * k;
          if (d2 > radius * radius) return;
          (d2 > (radius - 2) * (radius - 2) ? object.boundary : object.inner).insert(v);
        });
        break;
      case 1: {  // a plate along two axes
        const int axis = pick(0, 2);
        for_box([&](const VoxelIndex& v) {
          if ((axis == 0 && v.i == c.i) || (axis == 1 && v.j == c.j) || (axis == 2 && v.k == c.k)) {
            object.boundary.insert(v);
          }
        });
        break;
      }
      case 2:  // stray voxels
        for (int n = pick(1, 12); n > 0; --n) object.boundary.insert(inside());
        break;
      case 3:  // a brick of inner voxels without a skin
        for_box([&](const VoxelIndex& v) {
          if (std::abs(v.i - c.i) <= radius && std::abs(v.j - c.j) <= radius / 2) {
            object.inner.insert(v);
          }
        });
        break;
      case 4:  // a bar along x
        object.boundary.insert_run(lo.i, box.hi.i, c.j, c.k);
        break;
      default:  // noise of both kinds
        for_box([&](const VoxelIndex& v) {
          const int chance = pick(0, 99);
          if (chance < 5) object.boundary.insert(v);
          if (chance > 60) object.inner.insert(v);
        });
    }
  }
  if (object.boundary.count() == 0) object.boundary.insert(inside());
  // Boundary and inner voxels do not overlap.
  object.inner.blocks().for_each([&](const BlockIndex& b, const BitBlock&) {
    const BitBlock* boundary = object.boundary.blocks().find(b);
    if (boundary == nullptr) return;
    BitBlock& block = *object.inner.blocks().find(b);
    for (std::size_t row = 0; row < 64; ++row) block.words[row] &= ~boundary->words[row];
  });
  return object;
}

TEST(RankedNeighbours, AreTheTripleLoopsOnRandomObjects) {
  for (unsigned seed = 1; seed <= test::rounds(240u); ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](int lo, int hi) { return std::uniform_int_distribution(lo, hi)(random); };
    const LayerShape shape = seed % 2 == 0 ? LayerShape::cube : LayerShape::sphere;
    // Reach q*m is kept to 20 voxels or so so that the oracle takes milliseconds.
    const int m = 1 + static_cast<int>(seed / 2 % 8);
    const int q = pick(0, m == 1 ? 32 : 20 / m);
    const RandomObject object = random_object(random, q * m > 16 ? 10 : 20);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + to_string(shape) + ", m " +
                 std::to_string(m) + ", q " + std::to_string(q));
    expect_as_the_triple_loop(
        ranked_neighbours(object.boundary, object.inner, ShapingElement(shape, m), q),
        object.boundary, object.inner, shape, m, q);
    if (HasFailure()) break;
  }
}

// Long objects are ranked in several tiles; each tile must know enough of its neighbours.
TEST(RankedNeighbours, AreTheTripleLoopsAcrossTiles) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto pick = [&](int lo, int hi) { return std::uniform_int_distribution(lo, hi)(random); };
    const VoxelIndex lo{pick(-90, 0), pick(-90, 0), pick(-90, 0)};
    VoxelIndex size{6, 6, 6};
    (seed % 3 == 0 ? size.i : seed % 3 == 1 ? size.j : size.k) = 560;
    const VoxelBox box{lo, {lo.i + size.i, lo.j + size.j, lo.k + size.k}};
    RandomObject object{VoxelSet(box), VoxelSet(box)};
    for (int n = 0; n < 400; ++n) {
      const VoxelIndex v{pick(box.lo.i, box.hi.i - 1), pick(box.lo.j, box.hi.j - 1),
                         pick(box.lo.k, box.hi.k - 1)};
      if (object.boundary.contains(v) || object.inner.contains(v)) continue;
      (n % 3 == 0 ? object.boundary : object.inner).insert(v);
    }
    const int m = pick(2, 8), q = 20 / m;
    const LayerShape shape = pick(0, 1) == 0 ? LayerShape::cube : LayerShape::sphere;
    expect_as_the_triple_loop(
        ranked_neighbours(object.boundary, object.inner, ShapingElement(shape, m), q),
        object.boundary, object.inner, shape, m, q);
    if (HasFailure()) break;
  }
}

/// Whether two layers hold the same voxels, the second moved by `shift`.
bool same_layers(const RankedNeighbours& a, const RankedNeighbours& b, const VoxelIndex& shift) {
  if (a.ranks.size() != b.ranks.size()) return false;
  for (std::size_t n = 0; n < a.ranks.size(); ++n) {
    bool same = a.ranks[n].count() == b.ranks[n].count();
    a.ranks[n].for_each([&](const VoxelIndex& v) {
      same = same && b.ranks[n].contains({v.i + shift.i, v.j + shift.j, v.k + shift.k});
    });
    if (!same) return false;
  }
  return true;
}

TEST(RankedNeighbours, MoveWithTheObject) {
  std::mt19937 random(3);
  const RandomObject object = random_object(random, 30);
  const VoxelIndex shift{-77, 13, -5};
  const auto moved = [&](const VoxelSet& set) {
    const auto& [lo, hi] = set.box();
    VoxelSet result(VoxelBox{{lo.i + shift.i, lo.j + shift.j, lo.k + shift.k},
                             {hi.i + shift.i, hi.j + shift.j, hi.k + shift.k}});
    set.for_each([&](const VoxelIndex& v) {
      result.insert({v.i + shift.i, v.j + shift.j, v.k + shift.k});
    });
    return result;
  };
  const ShapingElement element(LayerShape::sphere, 4);
  EXPECT_TRUE(same_layers(
      ranked_neighbours(object.boundary, object.inner, element, 5),
      ranked_neighbours(moved(object.boundary), moved(object.inner), element, 5), shift));
}

TEST(RankedNeighbours, DoNotDependOnTheNumberOfThreads) {
  std::mt19937 random(11);
  for (int n = 0; n < 5; ++n) {
    const RandomObject object = random_object(random, 60);
    const ShapingElement element(LayerShape::sphere, 4);
    std::vector<RankedNeighbours> layers;
    for (const std::size_t threads : {1u, 2u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      layers.push_back(ranked_neighbours(object.boundary, object.inner, element, 6));
    }
    EXPECT_TRUE(same_layers(layers[0], layers[1], {0, 0, 0}));
  }
}

TEST(RankedNeighbours, OfAFarFlungObjectTakeLittleMemory) {
  // Two voxels at opposite corners of a plant room.
  VoxelSet boundary(VoxelBox{{0, 0, 0}, {10000, 8000, 4000}});
  boundary.insert({0, 0, 0});
  boundary.insert({9999, 7999, 3999});
  const RankedNeighbours layers =
      ranked_neighbours(boundary, VoxelSet(boundary.box()), ShapingElement(LayerShape::cube, 4), 2);
  EXPECT_EQ(layers.ranks[0].count(), 2u * (9 * 9 * 9 - 1));
  EXPECT_EQ(layers.ranks[1].count(), 2u * (17 * 17 * 17 - 9 * 9 * 9));
  EXPECT_LE(layers.ranks[1].blocks().block_count(), 2u * 3 * 4 * 4);
}

TEST(RankedNeighbours, OfNoRanksAreNone) {
  VoxelSet boundary(VoxelBox{{0, 0, 0}, {1, 1, 1}});
  boundary.insert({0, 0, 0});
  const ShapingElement element(LayerShape::cube, 1);
  EXPECT_TRUE(ranked_neighbours(boundary, VoxelSet(), element, 0).ranks.empty());
}

TEST(RankedNeighbours, OfNothingAreEmpty) {
  const RankedNeighbours layers =
      ranked_neighbours(VoxelSet(), VoxelSet(), ShapingElement(LayerShape::cube, 1), 3);
  ASSERT_EQ(layers.ranks.size(), 3u);
  for (const VoxelSet& rank : layers.ranks) EXPECT_EQ(rank.count(), 0u);
}

TEST(RankedNeighbours, RefuseANumberOfRanksOutOfRange) {
  const ShapingElement element(LayerShape::cube, 1);
  EXPECT_THROW(ranked_neighbours(VoxelSet(), VoxelSet(), element, -1), Error);
  EXPECT_THROW(ranked_neighbours(VoxelSet(), VoxelSet(), element, 33), Error);
}

}  // namespace
}  // namespace vicinity
