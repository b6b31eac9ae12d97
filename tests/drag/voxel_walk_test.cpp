// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/voxel_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "no_allocation.h"

namespace vicinity {
namespace {

struct Visit {
  VoxelIndex voxel;
  double enter, leave;
};

std::vector<Visit> walk(const Vec3& from, const Vec3& to) {
  std::vector<Visit> visits;
  visits.reserve(1 << 11);
  walk_voxels(from, to, [&](const VoxelIndex& voxel, double enter, double leave) noexcept {
    visits.push_back({voxel, enter, leave});
  });
  return visits;
}

VoxelIndex voxel_of(const Vec3& grid) {
  return Workspace{.voxel_size = 1, .dims = {}}.index_of(grid);
}

int steps_between(const VoxelIndex& a, const VoxelIndex& b) {
  return std::abs(a.i - b.i) + std::abs(a.j - b.j) + std::abs(a.k - b.k);
}

// Paths of all lengths and slants; one in four has coordinates on grid planes, where ties are.
struct RandomPath {
  explicit RandomPath(unsigned seed) {
    std::mt19937 random(seed);
    const double size = std::array{0.5, 3.0, 20.0, 200.0}[seed % 4];
    std::uniform_real_distribution<double> coordinate(-size, size);
    const bool on_planes = seed % 16 < 4;
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = coordinate(random);
      to[axis] = coordinate(random);
      if (on_planes) {
        from[axis] = std::round(from[axis] * 2) / 2;
        to[axis] = std::round(to[axis] * 2) / 2;
      }
    }
  }
  Vec3 from, to;
};

TEST(VoxelWalk, GoesFromTheFirstVoxelToTheLastFaceByFace) {
  for (unsigned seed = 0; seed < 4000; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const RandomPath path(seed);
    const std::vector<Visit> visits = walk(path.from, path.to);
    const VoxelIndex first = voxel_of(path.from), last = voxel_of(path.to);
    ASSERT_EQ(visits.front().voxel, first);
    ASSERT_EQ(visits.back().voxel, last);
    // One voxel for each grid plane that is crossed, and the first.
    ASSERT_EQ(visits.size(), 1u + static_cast<std::size_t>(steps_between(first, last)));
    for (std::size_t n = 1; n < visits.size(); ++n) {
      ASSERT_EQ(steps_between(visits[n - 1].voxel, visits[n].voxel), 1);
    }
  }
}

TEST(VoxelWalk, VisitsEveryVoxelThatAFinelySampledPathFinds) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const RandomPath path(seed);
    const std::vector<Visit> visits = walk(path.from, path.to);
    const int samples = 200 + 50 * static_cast<int>((path.to - path.from).norm());
    std::size_t at = 0;
    for (int n = 0; n <= samples; ++n) {
      const Vec3 p = path.from + static_cast<double>(n) / samples * (path.to - path.from);
      // On a plane, rounding decides which side the sample takes.
      if (((p.array() - p.array().round()).abs() < 1e-9).any()) continue;
      // In order: the samples' voxels are a subsequence of the visited ones.
      while (at < visits.size() && visits[at].voxel != voxel_of(p)) ++at;
      ASSERT_LT(at, visits.size()) << "sample " << n << " at " << p.transpose();
    }
  }
}

TEST(VoxelWalk, SaysWhereOnThePathEachVoxelLies) {
  for (unsigned seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const RandomPath path(seed);
    const std::vector<Visit> visits = walk(path.from, path.to);
    EXPECT_EQ(visits.back().leave, 1);
    for (std::size_t n = 0; n < visits.size(); ++n) {
      const auto& [voxel, enter, leave] = visits[n];
      ASSERT_LE(enter, leave);
      ASSERT_EQ(enter, n == 0 ? 0 : visits[n - 1].leave);
      const Vec3 middle = path.from + 0.5 * (enter + leave) * (path.to - path.from);
      const Vec3 centre = Vec3(voxel.i, voxel.j, voxel.k) + Vec3::Constant(0.5);
      ASSERT_LE((middle - centre).cwiseAbs().maxCoeff(), 0.5 + 1e-9);
    }
  }
}

TEST(VoxelWalk, StaysInOneVoxelWithoutLength) {
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(-1, 2, -3), Vec3(0.5, -0.25, 7.75)}) {
    const std::vector<Visit> visits = walk(p, p);
    ASSERT_EQ(visits.size(), 1u);
    EXPECT_EQ(visits[0].voxel, voxel_of(p));
    EXPECT_EQ(visits[0].enter, 0);
    EXPECT_EQ(visits[0].leave, 1);
  }
}

TEST(VoxelWalk, FollowsEachAxisBothWaysAcrossZero) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Vec3 side = Vec3::Constant(0.5) - 0.5 * Vec3::Unit(axis);
      const std::vector<Visit> visits =
          walk(side - sign * 2.5 * Vec3::Unit(axis), side + sign * 2.5 * Vec3::Unit(axis));
      ASSERT_EQ(visits.size(), 6u);
      for (std::size_t n = 0; n < 6; ++n) {
        const double along = sign * (static_cast<double>(n) - 2.5);
        EXPECT_EQ(visits[n].voxel, voxel_of(side + along * Vec3::Unit(axis)));
      }
    }
  }
}

TEST(VoxelWalk, DoesNotSlipBetweenVoxelsThatMeetAtACorner) {
  const std::vector<Visit> visits = walk({0.5, 0.5, 0.5}, {3.5, 3.5, 3.5});
  EXPECT_EQ(visits.size(), 10u);
  // Any layer of voxels x + y + z = const is met.
  for (int sum = 0; sum <= 9; ++sum) {
    EXPECT_TRUE(std::any_of(visits.begin(), visits.end(), [&](const Visit& visit) {
      return visit.voxel.i + visit.voxel.j + visit.voxel.k == sum;
    })) << sum;
  }
}

TEST(VoxelWalk, EndsForTheTiniestAndTheLargestNumbers) {
  constexpr double tiny = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(walk({-tiny, -tiny, -tiny}, {tiny, tiny, tiny}).back().voxel, (VoxelIndex{0, 0, 0}));
  EXPECT_EQ(walk({tiny, 0, 0}, {-tiny, 0, 0}).back().voxel, (VoxelIndex{-1, 0, 0}));
  const double far = 2147483000.25;
  EXPECT_EQ(walk({far, far, far}, {far - 20, far + 7, far}).back().voxel,
            voxel_of({far - 20, far + 7, far}));
  EXPECT_EQ(walk({-far, -far, 0}, {-far + 5, -far - 3, 1}).back().voxel,
            voxel_of({-far + 5, -far - 3, 1}));
}

TEST(VoxelWalk, TakesNoMemoryFromTheHeap) {
  std::size_t visited = 0;
  const NoAllocation guard;
  walk_voxels({-20.3, 4, 7.5}, {80, -33.3, 7.5},
              [&](const VoxelIndex&, double, double) noexcept { ++visited; });
  EXPECT_GT(visited, 100u);
}

}  // namespace
}  // namespace vicinity
