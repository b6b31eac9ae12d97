// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/layers/shaping_element.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <tuple>

#include "layers/triple_loop.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

TEST(ShapingElement, HasTheCellCountsOfThePaper) {
  const int cube[] = {27, 125, 343, 729};
  const int sphere[] = {7, 33, 123, 257};
  for (int m = 1; m <= 4; ++m) {
    EXPECT_EQ(ShapingElement(LayerShape::cube, m).cell_count(), cube[m - 1]);
    EXPECT_EQ(ShapingElement(LayerShape::sphere, m).cell_count(), sphere[m - 1]);
  }
}

TEST(ShapingElement, RowsHoldEachCellOnce) {
  for (const LayerShape shape : {LayerShape::cube, LayerShape::sphere}) {
    for (int m = 1; m <= 8; ++m) {
      const ShapingElement element(shape, m);
      std::set<std::tuple<int, int, int>> cells;
      for (const ShapingElement::Row& row : element.rows()) {
        for (int i = -row.reach; i <= row.reach; ++i) {
          EXPECT_TRUE(cells.insert({i, row.j, row.k}).second);
        }
      }
      for (int k = -m - 1; k <= m + 1; ++k) {
        for (int j = -m - 1; j <= m + 1; ++j) {
          for (int i = -m - 1; i <= m + 1; ++i) {
            EXPECT_EQ(element.contains(i, j, k), cells.count({i, j, k}) == 1);
          }
        }
      }
    }
  }
}

TEST(ShapingElement, RefusesARadiusOutOfRangeAndAShapeWithoutMask) {
  EXPECT_THROW(ShapingElement(LayerShape::cube, 0), Error);
  EXPECT_THROW(ShapingElement(LayerShape::sphere, 9), Error);
  EXPECT_THROW(ShapingElement(LayerShape::distance, 4), Error);
}

TEST(LayerShape, HasAName) {
  EXPECT_STREQ(to_string(LayerShape::cube), "cube");
  EXPECT_STREQ(to_string(LayerShape::sphere), "sphere");
  EXPECT_STREQ(to_string(LayerShape::distance), "distance");
}

/// How near each rank comes to one lone voxel, by forming its layers and looking at every one of
/// their voxels.
std::vector<double> nearest_by_looking(LayerShape shape, int m, int q) {
  VoxelSet voxel(VoxelBox{{0, 0, 0}, {1, 1, 1}});
  voxel.insert({0, 0, 0});
  triple_loop::ObjectVoxelArray ova =
      triple_loop::ranked_neighbours(voxel, VoxelSet(), shape, m, q);
  std::vector<double> nearest(static_cast<std::size_t>(q), std::numeric_limits<double>::infinity());
  for (int k = ova.box.lo.k; k < ova.box.hi.k; ++k) {
    for (int j = ova.box.lo.j; j < ova.box.hi.j; ++j) {
      for (int i = ova.box.lo.i; i < ova.box.hi.i; ++i) {
        const int rank = ova.at(i, j, k);
        if (rank < 1) continue;
        const auto gap = [](int d) { return std::max(std::abs(d) - 1, 0); };
        double& so_far = nearest[static_cast<std::size_t>(rank - 1)];
        so_far = std::min(so_far, std::hypot(gap(i), gap(j), gap(k)));
      }
    }
  }
  return nearest;
}

TEST(RankBound, IsTrueAndTightForALoneVoxel) {
  for (const LayerShape shape : {LayerShape::cube, LayerShape::sphere}) {
    for (int m = 1; m <= 8; ++m) {
      for (int q = 0; q * m <= 24; ++q) {
        const std::vector<double> nearest = nearest_by_looking(shape, m, q);
        EXPECT_THAT(nearest_by_rank_vox(shape, m, q),
                    testing::Pointwise(testing::DoubleNear(1e-12), nearest))
            << to_string(shape) << ", m " << m << ", q " << q;
        double bound = 0;
        for (std::size_t n = 0; n < nearest.size(); ++n) {
          bound = std::max(bound, static_cast<double>(n) * m - nearest[n]);
        }
        EXPECT_NEAR(rank_bound_vox(shape, m, q), bound, 1e-12)
            << to_string(shape) << ", m " << m << ", q " << q;
      }
    }
  }
}

TEST(RankBound, IsZeroForCubeAndDistance) {
  EXPECT_EQ(rank_bound_vox(LayerShape::cube, 8, 32), 0);
  EXPECT_EQ(rank_bound_vox(LayerShape::distance, 8, 32), 0);
}

TEST(RankBound, NeverFallsWithMoreRanks) {
  double last = 0;
  for (const int q : {0, 1, 2, 3, 5, 8, 13, 21, 32}) {
    const double bound = rank_bound_vox(LayerShape::sphere, 8, q);
    EXPECT_GE(bound, last);
    last = bound;
  }
  EXPECT_GT(last, 0);
  EXPECT_LT(last, 31 * 8);
}

TEST(RankBound, RefusesANumberOfRanksOutOfRange) {
  EXPECT_THROW(rank_bound_vox(LayerShape::sphere, 4, -1), Error);
  EXPECT_THROW(rank_bound_vox(LayerShape::sphere, 4, 33), Error);
  EXPECT_THROW(rank_bound_vox(LayerShape::sphere, 9, 6), Error);
}

}  // namespace
}  // namespace vicinity
