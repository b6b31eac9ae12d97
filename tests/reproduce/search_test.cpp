// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The searches that the lookup is measured against, and the verdicts on them.

#include "reproduce/search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bench_room.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity::report {
namespace {

// Far more points on each triangle than its distance is worth: the least of their distances is an
// upper bound, and no farther off than their spacing.
double sampled_distance(const std::vector<Corners>& triangles, const Vec3& p) {
  constexpr int steps = 60;
  double least = INFINITY;
  for (const Corners& t : triangles) {
    for (int a = 0; a <= steps; ++a) {
      for (int b = 0; a + b <= steps; ++b) {
        const Vec3 at =
            t[0] + (t[1] - t[0]) * (a / double{steps}) + (t[2] - t[0]) * (b / double{steps});
        least = std::min(least, (p - at).norm());
      }
    }
  }
  return least;
}

TEST(NearestSurface, TreeAndSamplesOfTheSurfaceSayTheSameAndProjectionIsNeverNearer) {
  const std::vector<Corners> triangles = corners_of(primitive::tube(3, 2, 4, 12), 1);
  const TriangleTree tree(triangles);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-5, 5);
  int shaded = 0;
  for (int n = 0; n < 60; ++n) {
    const Vec3 p(place(random), place(random), place(random));
    const double sampled = sampled_distance(triangles, p), found = tree.nearest(p).distance;
    EXPECT_LE(found, sampled + 1e-9) << p.transpose();
    EXPECT_GE(found, sampled - 0.05) << p.transpose();
    const Projection projection = nearest_by_projection(triangles, p);
    if (projection.found) {
      EXPECT_GE(projection.distance, found - 1e-9) << p.transpose();
    }
    shaded += projection.found ? 0 : 1;
  }
  EXPECT_GT(shaded, 0);
}

TEST(NearestSurface, NoTriangleOfACubeIsBeforeAPointBeyondItsCorner) {
  const std::vector<Corners> cube = corners_of(primitive::box({2, 2, 2}), 1);
  EXPECT_FALSE(nearest_by_projection(cube, {2, 2, 0}).found);
  EXPECT_TRUE(nearest_by_projection(cube, {2, 0.5, 0}).found);
  EXPECT_DOUBLE_EQ(nearest_by_projection(cube, {2, 0.5, 0}).distance, 1);
}

TEST(Fig8, TurnsWhereTheLookupMissesAPointOrTheSearchMissesNone) {
  const std::vector<ShadedCorners> parts{{"pentagon", 100, 30, 0, 0, 5},
                                         {"curved", 100, 30, 0, 0, 64},
                                         {"complex", 100, 30, 4, 0, 80}};
  EXPECT_TRUE(agrees(check_fig8(parts))) << why(check_fig8(parts));
  std::vector<ShadedCorners> missed = parts;
  missed[1].unlabelled = 1;
  EXPECT_FALSE(agrees(check_fig8(missed)));
  std::vector<ShadedCorners> none = parts;
  none[0].shaded = 0;
  EXPECT_FALSE(agrees(check_fig8(none)));
}

TEST(Fig7, TurnsWhereTheLookupIsSlowerOrTheTreeWrong) {
  const QueryCost small{.triangles = 48, .sequential_ns = 500, .tree_ns = 700, .lookup_ns = 12};
  const QueryCost large{.triangles = 65024, .sequential_ns = 5e5, .tree_ns = 1e4, .lookup_ns = 12};
  EXPECT_TRUE(agrees(check_fig7({small, large})));
  QueryCost slow = large;
  slow.lookup_ns = 2e4;
  EXPECT_FALSE(agrees(check_fig7({small, slow})));
  QueryCost wrong = large;
  wrong.tree_error_vox = 0.1;
  EXPECT_FALSE(agrees(check_fig7({small, wrong})));
  EXPECT_FALSE(agrees(check_fig7({})));
}

}  // namespace
}  // namespace vicinity::report
