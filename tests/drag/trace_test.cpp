// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <random>

#include "drag/fields.h"
#include "drag/presets.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

// Ranks 6, 5, .. 1 in slabs of 4 m from x = 10 on, a wall from x = 34.
ViscosityField slabs() {
  return painted_field({60, 10, 10}, [](const VoxelIndex& v) {
    if (v.i >= 34) return VoxelRecord{VoxelKind::inner, 0, 0};
    if (v.i < 10) return VoxelRecord{};
    return VoxelRecord{VoxelKind::neighbour, static_cast<std::uint8_t>(6 - (v.i - 10) / 4), 0};
  });
}

double highest_force(const std::vector<TraceSample>& samples) {
  double highest = 0;
  for (const TraceSample& sample : samples) highest = std::max(highest, sample.force_W.norm());
  return highest;
}

TEST(Trace, SamplesTheTrackEvenlyAndItsEnd) {
  const ViscosityField field = slabs();
  const auto samples =
      trace(field, {.from_W = {0, 5, 5}, .to_W = {10, 5, 5}, .speed = 4, .rate = 10});
  ASSERT_EQ(samples.size(), 26u);  // 2.5 s at 10 Hz, and the start
  for (std::size_t n = 0; n < samples.size(); ++n) {
    EXPECT_NEAR(samples[n].t, 0.1 * static_cast<double>(n), 1e-12);
    EXPECT_NEAR(samples[n].p_WR.x(), 0.4 * static_cast<double>(n), 1e-12);
  }
  EXPECT_EQ(samples.back().p_WR, Vec3(10, 5, 5));
  const auto uneven =
      trace(field, {.from_W = {0, 5, 5}, .to_W = {10, 5, 5}, .speed = 4, .rate = 0.9});
  ASSERT_EQ(uneven.size(), 4u);
  EXPECT_DOUBLE_EQ(uneven.back().t, 2.5);
}

TEST(Trace, FollowsAPathAsTheTrackThatPassesThere) {
  const ViscosityField field = slabs();
  const Track track{.from_W = {0, 5, 5}, .to_W = {33.9, 5, 5}, .speed = 0.5, .rate = 10};
  const DragOptions options{.area = 0.25, .memory = named_memory("short")};
  const auto along_track = trace(field, track, options);
  std::vector<Vec3> path;
  for (const TraceSample& sample : along_track) path.push_back(sample.p_WR);
  const auto along_path = trace(field, path, track.rate, options);
  ASSERT_EQ(along_path.size(), path.size());
  EXPECT_EQ(along_path.front().force_W, Vec3(0, 0, 0));
  for (std::size_t n = 1; n < path.size(); ++n) {
    EXPECT_EQ(along_path[n].p_WR, path[n]);
    EXPECT_EQ(along_path[n].mu_e, along_track[n].mu_e);
    EXPECT_NEAR((along_path[n].force_W - along_track[n].force_W).norm(), 0, 1e-10);
  }
  EXPECT_TRUE(trace(field, std::vector<Vec3>()).empty());
  path[7].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(trace(field, path), Error);
}

TEST(Trace, FeelsEachRankAsMuTimesAreaTimesSpeed) {
  const auto samples = trace(slabs(), {.from_W = {0, 5, 5}, .to_W = {33.9, 5, 5}, .speed = 0.5},
                             {.area = 0.25, .memory = {}});
  const std::array mu{32.0, 25.0, 20.0, 17.0, 15.0, 13.0};
  std::array<int, 6> seen{};
  for (const TraceSample& sample : samples) {
    if (sample.record.kind == VoxelKind::empty) {
      EXPECT_EQ(sample.force_W.norm(), 0);
      continue;
    }
    const auto n = static_cast<std::size_t>(sample.record.rank - 1);
    ++seen[n];
    EXPECT_EQ(sample.mu, mu[n]);
    EXPECT_EQ(sample.mu_e, mu[n]);
    EXPECT_NEAR(sample.force_W.x(), -mu[n] * 0.25 * 0.5, 1e-12);
  }
  for (const int samples_in_rank : seen) EXPECT_NEAR(samples_in_rank, 8000, 200);
}

TEST(Trace, FallsToHalfTheForceAtHalfTheSpeed) {
  const ViscosityField field = slabs();
  const Track fast{.from_W = {0, 5, 5}, .to_W = {33, 5, 5}, .speed = 2};
  Track slow = fast;
  slow.speed = 1;
  EXPECT_DOUBLE_EQ(highest_force(trace(field, fast)), 2 * highest_force(trace(field, slow)));
}

TEST(Trace, OnlyTakesEnergyOutWhateverTheSettings) {
  const ViscosityField field = slabs();
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(-5, 65), side(-2, 12);
    const Track track{.from_W = {x(random), side(random), side(random)},
                      .to_W = {x(random), side(random), side(random)},
                      .speed = std::array{0.5, 5.0, 500.0, 50'000.0}[seed % 4]};
    const DragOptions options{
        .memory = named_memory(presets[seed % 5]),
        .direction = seed % 2 == 0 ? DragDirection::all : DragDirection::closing,
        .traversal = seed % 3 == 0 ? Traversal::sampled : Traversal::swept};
    const Vec3 v = track.to_W - track.from_W;
    for (const TraceSample& sample : trace(field, track, options)) {
      ASSERT_LE(sample.force_W.dot(v), 0);
      ASSERT_GE(sample.mu_e, 0);
      ASSERT_LE(sample.mu_e, 100);
    }
  }
}

TEST(Trace, ClosingIsNeverMoreThanAll) {
  const ViscosityField field = field_around(primitive::cone(0.12, 0.225), LayerShape::sphere, 0.01);
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-0.4, 0.4);
    const auto anywhere = [&] {
      return Vec3(coordinate(random), coordinate(random), coordinate(random));
    };
    const Track track{.from_W = anywhere(), .to_W = anywhere(), .speed = 0.5};
    const MemoryWeights memory = named_memory(presets[seed % 5]);
    const auto all = trace(field, track, {.memory = memory});
    const auto closing =
        trace(field, track, {.memory = memory, .direction = DragDirection::closing});
    ASSERT_EQ(all.size(), closing.size());
    for (std::size_t n = 0; n < all.size(); ++n) {
      ASSERT_LE(closing[n].force_W.norm(), all[n].force_W.norm() * (1 + 1e-14));
      ASSERT_EQ(closing[n].mu_e, all[n].mu_e);
    }
  }
}

TEST(Trace, RetreatFromAPlateIsFreeAndApproachIsNot) {
  for (const LayerShape layers : {LayerShape::cube, LayerShape::sphere, LayerShape::distance}) {
    SCOPED_TRACE(to_string(layers));
    const ViscosityField field = field_around(primitive::box({1, 1, 0.001}), layers, 0.01);
    for (const char* memory : presets) {
      SCOPED_TRACE(memory);
      const DragOptions options{.memory = named_memory(memory),
                                .direction = DragDirection::closing};
      const Vec3 near(0.02, 0.03, 0.012), far(0.02, 0.03, 0.5);
      EXPECT_EQ(highest_force(trace(field, {.from_W = near, .to_W = far}, options)), 0);
      EXPECT_GT(highest_force(trace(field, {.from_W = far, .to_W = near}, options)), 2);
      // Sliding along, too, but for the direction's last bits.
      EXPECT_LT(highest_force(
                    trace(field, {.from_W = near + 0.1 * Vec3::UnitX(), .to_W = near}, options)),
                1e-3);
    }
  }
}

// Figure 22: apex up, height 45, base radius 24 voxels, m = 4, q = 6; tracks along x in the
// vertical plane that touches the base.
TEST(Trace, OfThePapersConeFallsWithHeightInSteps) {
  const double h = 0.005;
  // A cone stands with its middle at the origin: z = 0 of the paper is half its height below.
  const ViscosityField field =
      field_around(primitive::cone(24.4 * h, 45 * h, 128), LayerShape::sphere, h);
  double before = std::numeric_limits<double>::infinity();
  for (const int height : {1, 10, 20, 30, 40, 45}) {
    SCOPED_TRACE(height);
    const double z = (height + 0.5 - 22.5) * h, y = -25.5 * h;
    const auto samples = trace(field, {.from_W = {-0.4, y, z}, .to_W = {0.4, y, z}, .speed = 0.2});
    const double most = highest_force(samples);
    EXPECT_LE(most, before);
    if (height <= 40) {
      EXPECT_GT(most, 0);
    } else {
      EXPECT_EQ(most, 0);
    }
    // Up in steps to the middle, and down again.
    const auto middle = samples.size() / 2;
    for (std::size_t n = 1; n < samples.size(); ++n) {
      const double change = samples[n].force_W.norm() - samples[n - 1].force_W.norm();
      EXPECT_GE(n <= middle ? change : -change, 0) << "at x = " << samples[n].p_WR.x();
    }
    before = most;
  }
}

TEST(Trace, WithoutLengthIsOneSampleAtRest) {
  const auto samples = trace(slabs(), {.from_W = {30.5, 5, 5}, .to_W = {30.5, 5, 5}});
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].mu_e, 32);
  EXPECT_EQ(samples[0].force_W, Vec3(0, 0, 0));
}

TEST(Trace, RefusesWhatIsNoTrackAndSaysWhich) {
  const ViscosityField field = slabs();
  const Track good{.from_W = {0, 0, 0}, .to_W = {1, 0, 0}};
  const auto refused = [&](const Track& track, const DragOptions& options = {}) -> std::string {
    try {
      trace(field, track, options);
      return "";
    } catch (const Error& error) {
      return error.parts().where;
    }
  };
  EXPECT_EQ(refused(good), "");
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()}) {
    Track track = good;
    track.speed = bad;
    EXPECT_EQ(refused(track), "speed");
    track = good;
    track.rate = bad;
    EXPECT_EQ(refused(track), "rate");
  }
  EXPECT_EQ(refused({.from_W = {0, 0, std::numeric_limits<double>::quiet_NaN()}}), "from, to");
  EXPECT_EQ(refused(good, {.area = -1}), "area");
  EXPECT_EQ(refused({.to_W = {1e9, 0, 0}, .speed = 1e-3}), "rate");
}

}  // namespace
}  // namespace vicinity
