// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/viscosity_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <numeric>
#include <random>
#include <vector>

#include "drag/presets.h"
#include "no_allocation.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

// Eq. (6-7) as they stand in the paper, on a list that only grows at its head.
class PlainMemory {
 public:
  PlainMemory(std::vector<double> alpha, double first)
      : alpha_(std::move(alpha)), mu_(alpha_.size(), first) {}
  void enter_voxel(double mu) { mu_.push_front(mu); }
  double effective() const {
    double sum = 0;
    for (std::size_t i = 0; i < alpha_.size(); ++i) sum += alpha_[i] * mu_[i];
    return sum / std::accumulate(alpha_.begin(), alpha_.end(), 0.0);
  }

 private:
  std::vector<double> alpha_;
  std::deque<double> mu_;
};

TEST(ViscosityMemory, PresetsAreThePapersEquationOnAPlainList) {
  const std::vector<std::pair<const char*, std::vector<double>>> printed{
      {"none", {1}},
      {"sustained", std::vector<double>(10, 1)},
      {"fading", {1, 0.9, 0.7, 0.5, 0.55, 0.30, 0.2, 0.1, 0.05, 0.02}},
      {"short", {1, 1, 1}},
  };
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> viscosity(0, 100);
    for (const auto& [name, alpha] : printed) {
      SCOPED_TRACE(name);
      const MemoryWeights weights = named_memory(name);
      const double first = viscosity(random);
      ViscosityMemory memory;
      memory.start(first);
      PlainMemory plain(alpha, first);
      EXPECT_NEAR(memory.effective(weights), first, 1e-12);
      for (int n = 0; n < 100; ++n) {
        const double mu = viscosity(random);
        memory.enter_voxel(mu);
        plain.enter_voxel(mu);
        ASSERT_NEAR(memory.effective(weights), plain.effective(), 1e-12) << "after voxel " << n;
      }
    }
  }
}

TEST(ViscosityMemory, FollowsTheHandComputedStepOfThePapersFirstLayers) {
  ViscosityMemory memory;
  memory.start(20);
  memory.enter_voxel(32);
  EXPECT_DOUBLE_EQ(memory.effective(named_memory("none")), 32);
  EXPECT_DOUBLE_EQ(memory.effective(named_memory("short")), (32 + 2 * 20) / 3.0);
  EXPECT_DOUBLE_EQ(memory.effective(named_memory("sustained")), (32 + 9 * 20) / 10.0);
  EXPECT_DOUBLE_EQ(memory.effective(named_memory("fading")), (1 * 32 + 3.32 * 20) / 4.32);
  EXPECT_DOUBLE_EQ(memory.effective(named_memory("rising")), 32);
}

TEST(ViscosityMemory, EffectiveLiesBetweenTheLowestAndHighestRememberedExactly) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> viscosity(0, 100);
    for (const char* name : presets) {
      SCOPED_TRACE(name);
      const MemoryWeights weights = named_memory(name);
      std::deque<double> latest(static_cast<std::size_t>(weights.k), viscosity(random));
      ViscosityMemory memory;
      memory.start(latest.front());
      for (int n = 0; n < 100; ++n) {
        const double mu = n % 7 == 0 ? latest.front() : viscosity(random);
        if (n % 5 == 0) {
          latest.front() = mu;
          memory.update(mu);
        } else {
          latest.push_front(mu);
          latest.pop_back();
          memory.enter_voxel(mu);
        }
        const auto [lowest, highest] = std::minmax_element(latest.begin(), latest.end());
        ASSERT_GE(memory.effective(weights), *lowest);
        ASSERT_LE(memory.effective(weights), *highest);
      }
    }
  }
}

TEST(ViscosityMemory, EvenSurroundingsAreFeltToTheLastBit) {
  for (const char* name : presets) {
    ViscosityMemory memory;
    memory.start(0.1);
    for (int n = 0; n < 40; ++n) memory.enter_voxel(0.1);
    EXPECT_EQ(memory.effective(named_memory(name)), 0.1) << name;
  }
}

TEST(ViscosityMemory, RisingNeverHidesNearness) {
  const MemoryWeights rising = named_memory("rising"), sustained = named_memory("sustained");
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> viscosity(0, 100);
    ViscosityMemory memory;
    memory.start(viscosity(random));
    for (int n = 0; n < 200; ++n) {
      const double mu = viscosity(random);
      memory.enter_voxel(mu);
      ASSERT_GE(memory.effective(rising), mu);
      ASSERT_GE(memory.effective(rising), memory.effective(sustained));
    }
  }
}

TEST(ViscosityMemory, RisingSmoothsAFall) {
  const MemoryWeights rising = named_memory("rising");
  ViscosityMemory memory;
  memory.start(32);
  double before = 32;
  for (int n = 1; n <= 10; ++n) {
    memory.enter_voxel(0);
    EXPECT_NEAR(memory.effective(rising), 32 * (10 - n) / 10.0, 1e-12);
    EXPECT_LT(memory.effective(rising), before);
    before = memory.effective(rising);
  }
}

TEST(ViscosityMemory, OnlyTheLatestKVoxelsCount) {
  for (const char* name : presets) {
    SCOPED_TRACE(name);
    const MemoryWeights weights = named_memory(name);
    ViscosityMemory memory;
    memory.start(100);
    for (int n = 0; n < weights.k; ++n) memory.enter_voxel(3);
    EXPECT_EQ(memory.effective(weights), 3);
  }
}

TEST(ViscosityMemory, MotionWithinAVoxelReplacesItsValueAndRecordsNothing) {
  const MemoryWeights weights = named_memory("short");
  ViscosityMemory memory;
  memory.start(10);
  memory.enter_voxel(20);
  for (const double mu : {21.0, 22.0, 26.0}) memory.update(mu);
  EXPECT_DOUBLE_EQ(memory.effective(weights), (26 + 10 + 10) / 3.0);
}

TEST(ViscosityMemory, TakesNoMemoryFromTheHeap) {
  const MemoryWeights weights = named_memory("fading");
  const NoAllocation guard;
  ViscosityMemory memory;
  memory.start(1);
  for (int n = 0; n < 100; ++n) {
    memory.enter_voxel(n);
    memory.update(n + 0.5);
    EXPECT_GE(memory.effective(weights), 0);
  }
}

TEST(NamedMemory, AnotherNameIsAnErrorThatNamesThePresets) {
  try {
    named_memory("fadign");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().found, "'fadign'");
    for (const char* name : presets) {
      EXPECT_NE(error.parts().expected.find(name), std::string::npos) << name;
    }
  }
}

}  // namespace
}  // namespace vicinity
