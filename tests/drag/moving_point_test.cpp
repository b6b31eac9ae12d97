// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/moving_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include "drag/fields.h"
#include "drag/presets.h"
#include "no_allocation.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

VoxelRecord rank(int n) { return {VoxelKind::neighbour, static_cast<std::uint8_t>(n), 0}; }

// 100 x 20 x 20 m; the sheet x = 50 is one voxel of rank 1 thick.
ViscosityField thin_sheet() {
  return painted_field({100, 20, 20},
                       [](const VoxelIndex& v) { return v.i == 50 ? rank(1) : VoxelRecord{}; });
}

// Ranks in random voxels, a third of them empty.
ViscosityField confetti(unsigned seed) {
  std::mt19937 random(seed);
  return painted_field({40, 40, 40}, [&](const VoxelIndex&) {
    const int n = static_cast<int>(random() % 9);
    return n < 6 ? rank(n + 1) : VoxelRecord{};
  });
}

TEST(MovingPoint, StartsWithItsMemoryFullOfTheFirstVoxel) {
  const ViscosityField field = thin_sheet();
  for (const char* name : presets) {
    MovingPoint point;
    EXPECT_EQ(point.advance(field, named_memory(name), Traversal::swept, {50.5, 3, 3}), 32) << name;
  }
}

TEST(MovingPoint, NeverMissesALayerOfOneVoxelAtAnySpeed) {
  const ViscosityField field = thin_sheet();
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> before(0, 50), after(51, 100), side(0, 20);
    const Vec3 from(before(random), side(random), side(random));
    const Vec3 to(after(random), side(random), side(random));
    for (const char* name : presets) {
      SCOPED_TRACE(name);
      MovingPoint forth, back;
      const MemoryWeights weights = named_memory(name);
      EXPECT_EQ(forth.advance(field, weights, Traversal::swept, from), 0);
      EXPECT_GT(forth.advance(field, weights, Traversal::swept, to), 0);
      EXPECT_EQ(back.advance(field, weights, Traversal::swept, to), 0);
      EXPECT_GT(back.advance(field, weights, Traversal::swept, from), 0);
    }
    MovingPoint point;
    point.advance(field, {}, Traversal::swept, from);
    EXPECT_EQ(point.advance(field, {}, Traversal::swept, to), 32) << "in full without a memory";
  }
}

TEST(MovingPoint, SampledFeelsOnlyWhereItArrives) {
  const ViscosityField field = thin_sheet();
  MovingPoint point;
  point.advance(field, {}, Traversal::sampled, {49, 3, 3});
  EXPECT_EQ(point.advance(field, {}, Traversal::sampled, {53, 3, 3}), 0);
  EXPECT_EQ(point.advance(field, {}, Traversal::sampled, {50.2, 3, 3}), 32);
}

TEST(MovingPoint, InOneLongStepPassesTheSameVoxelsAsInManyShortOnes) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const ViscosityField field = confetti(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-5, 45);
    const auto anywhere = [&] {
      return Vec3(coordinate(random), coordinate(random), coordinate(random));
    };
    const Vec3 from = anywhere(), to = anywhere();
    for (const char* name : presets) {
      const MemoryWeights weights = named_memory(name);
      MovingPoint leaping, creeping;
      leaping.advance(field, weights, Traversal::swept, from);
      creeping.advance(field, weights, Traversal::sampled, from);
      const double leapt = leaping.advance(field, weights, Traversal::swept, to);
      // Thousandths of a voxel: none of these paths passes a corner nearer than that.
      const int steps = 200'000;
      double highest = 0;
      for (int n = 1; n <= steps; ++n) {
        const Vec3 p = from + static_cast<double>(n) / steps * (to - from);
        const double mu_e = creeping.advance(field, weights, Traversal::sampled, p);
        if (field.workspace().index_of(p) != field.workspace().index_of(from)) {
          highest = std::max(highest, mu_e);
        }
      }
      EXPECT_DOUBLE_EQ(leapt, highest) << name;
      EXPECT_DOUBLE_EQ(leaping.advance(field, weights, Traversal::swept, to),
                       creeping.advance(field, weights, Traversal::sampled, to))
          << name;
      if (seed >= 5) break;  // the presets differ in weights only
    }
  }
}

TEST(MovingPoint, RemembersNothingOfTheFieldAfterALongWayOutside) {
  const ViscosityField field = confetti(1);
  for (const char* name : presets) {
    const MemoryWeights weights = named_memory(name);
    MovingPoint point;
    point.advance(field, weights, Traversal::swept, {20.5, 20.5, 20.5});
    point.advance(field, weights, Traversal::swept, {1e6, -3e8, 20});
    EXPECT_EQ(point.advance(field, weights, Traversal::swept, {1e7, -3e8, 20}), 0) << name;
    // And comes back through empty space.
    point.advance(field, weights, Traversal::swept, {-20, 20.5, 20.5});
    EXPECT_EQ(point.advance(field, weights, Traversal::swept, {-10, 20.5, 20.5}), 0) << name;
  }
}

TEST(MovingPoint, SurvivesEveryPositionThatADoubleCanHold) {
  const ViscosityField field = confetti(2);
  constexpr std::array values{0.0, -0.0, 1e-308, -1e-308, 20.0,   40.0,   -1.0,
                              1e9, -1e9, 3e9,    1e300,   -1e308, 1.7e308};
  const MemoryWeights weights = named_memory("sustained");
  std::mt19937 random(3);
  MovingPoint point;
  for (int n = 0; n < 20'000; ++n) {
    const Vec3 p(values[random() % values.size()], values[random() % values.size()],
                 values[random() % values.size()]);
    const auto traversal = n % 2 == 0 ? Traversal::swept : Traversal::sampled;
    const double mu_e = point.advance(field, weights, traversal, p);
    ASSERT_GE(mu_e, 0);
    ASSERT_LE(mu_e, 32);
  }
}

TEST(MovingPoint, APositionThatIsNoneLeavesItWhereItIs) {
  const ViscosityField field = thin_sheet();
  const MemoryWeights weights = named_memory("short");
  MovingPoint point;
  EXPECT_EQ(point.advance(field, weights, Traversal::swept, {NAN, 0, 0}), 0);
  point.advance(field, weights, Traversal::swept, {49.5, 3, 3});
  const double felt = point.advance(field, weights, Traversal::swept, {50.5, 3, 3});
  EXPECT_GT(felt, 0);
  for (const double bad : {static_cast<double>(NAN), infinity, -infinity}) {
    EXPECT_EQ(point.advance(field, weights, Traversal::swept, {50.5, bad, 3}), felt);
  }
  EXPECT_EQ(point.advance(field, weights, Traversal::swept, {50.6, 3, 3}), felt);
}

TEST(MovingPoint, ForgetsWhenItIsReset) {
  const ViscosityField field = thin_sheet();
  const MemoryWeights weights = named_memory("sustained");
  MovingPoint point;
  point.advance(field, weights, Traversal::swept, {50.5, 3, 3});
  point.reset();
  EXPECT_EQ(point.advance(field, weights, Traversal::swept, {3, 3, 3}), 0);
}

TEST(MovingPoint, FeelsNoStepsWhereDistanceIsKept) {
  const double h = 0.01;
  const ViscosityField field =
      field_around(primitive::sphere(0.1, 96), LayerShape::distance, h, 4, 6);
  MovingPoint point;
  const Vec3 from(-0.36, 0.013, 0.021), to(-0.12, 0.013, 0.021);
  const int steps = 4800;
  double before = point.advance(field, {}, Traversal::swept, from), highest = before;
  for (int n = 1; n <= steps; ++n) {
    const Vec3 p = from + static_cast<double>(n) / steps * (to - from);
    const double mu_e = point.advance(field, {}, Traversal::swept, p);
    // The steepest slope of the coding: from 13 to nothing in one layer of 4 voxels.
    const double steepest = 13 / (4 * h) * (to - from).norm() / steps;
    ASSERT_LT(std::abs(mu_e - before), 2 * steepest) << "at " << p.transpose();
    before = mu_e;
    highest = std::max(highest, mu_e);
  }
  EXPECT_GT(highest, 28);
}

TEST(MovingPoint, TakesNoMemoryFromTheHeap) {
  const ViscosityField ranked = confetti(4);
  const ViscosityField smooth =
      field_around(primitive::box({0.1, 0.1, 0.1}), LayerShape::distance, 0.01);
  const MemoryWeights weights = named_memory("fading");
  const NoAllocation guard;
  MovingPoint point;
  for (const ViscosityField* field : {&ranked, &smooth}) {
    point.reset();
    for (int n = 0; n < 50; ++n) {
      point.advance(*field, weights, Traversal::swept, {0.9 * n, 20, 0.5 * n});
      point.advance(*field, weights, Traversal::sampled, {0.01 * n, 0, 0});
      point.towards_surface(*field);
    }
  }
}

}  // namespace
}  // namespace vicinity
