// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Verdicts on the memory: turned by a filter that divides by k+1, by one that is late, by none.

#include <gtest/gtest.h>

#include <algorithm>

#include "bench_room.h"
#include "reproduce/memory.h"
#include "reproduce/parts.h"
#include "vicinity/drag/viscosity_memory.h"

namespace vicinity::report {
namespace {

using Checker = std::vector<Check> (*)(const std::vector<Felt>&);

struct Named {
  const char* name;
  Checker check;
};
constexpr Named items[] = {{"fig26", check_fig26},
                           {"fig28", check_fig28},
                           {"fig30", check_fig30},
                           {"table2", check_table2}};

class Memory : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const BenchRoom room;
    Layers layers{.m = 4, .q = 10, .coding = named_coding("linear", 10)};
    field_ = room.workshop().field(complex_cylinder(), layers);
    layers.shape = LayerShape::distance;
    continuous_ = room.workshop().field(complex_cylinder(), layers);
    cases_ = feel_all_cases(field_, continuous_);
  }
  static ViscosityField field_, continuous_;
  static std::vector<Felt> cases_;
};
ViscosityField Memory::field_, Memory::continuous_;
std::vector<Felt> Memory::cases_;

TEST_F(Memory, VerdictsAgreeWithTheMethodAsItIs) {
  for (const Named& item : items) {
    EXPECT_TRUE(agrees(item.check(cases_))) << item.name << ": " << why(item.check(cases_));
  }
}

TEST_F(Memory, AFilterThatDividesByKPlusOneTurnsEveryVerdict) {
  std::vector<Felt> broken = cases_;
  for (Felt& felt : broken) {
    const double k = named_memory(felt.memory).k;
    for (double& mu_e : felt.mu_e) mu_e *= k / (k + 1);
  }
  for (const Named& item : items) EXPECT_FALSE(agrees(item.check(broken))) << item.name;
}

TEST_F(Memory, RanksThatAreOffByOneTurnEveryVerdict) {
  const BenchRoom room;
  for (const double layer : {-4.0, 4.0}) {
    Part moved = complex_cylinder();
    for (Vec3& p : moved.mesh.vertices) p.y() += layer;
    const Layers layers{.m = 4, .q = 10, .coding = named_coding("linear", 10)};
    const std::vector<Felt> off = feel_all_cases(room.workshop().field(moved, layers), continuous_);
    for (const Named& item : items) {
      EXPECT_FALSE(agrees(item.check(off))) << item.name << ", " << layer << " voxels";
    }
  }
}

TEST_F(Memory, AFilterThatSmoothsNothingTurnsTheVerdictsOnSmoothing) {
  std::vector<Felt> broken = cases_;
  for (Felt& felt : broken) felt.mu_e = felt.mu;
  for (const Checker check : {check_fig26, check_fig28, check_table2}) {
    EXPECT_FALSE(agrees(check(broken)));
  }
}

TEST_F(Memory, SwappedCodingsTurnTheVerdictsOnRiseAndEnergy) {
  std::vector<Felt> broken = cases_;
  for (std::size_t n = 0; n < 4; ++n) {
    std::swap(broken[n].mu, broken[n + 4].mu);
    std::swap(broken[n].mu_e, broken[n + 4].mu_e);
  }
  EXPECT_FALSE(agrees(check_fig28(broken)));
  EXPECT_FALSE(agrees(check_fig30(broken)));
  EXPECT_FALSE(agrees(check_table2(broken)));
}

// The mean delay of a filter is the mean of its weights' ages: another route than the rises of a
// track.
TEST_F(Memory, MeasuredDelayIsTheMeanAgeOfTheWeights) {
  for (const Felt& felt : cases_) {
    if (felt.memory == "rising") continue;
    const MemoryWeights weights = named_memory(felt.memory);
    double age = 0, sum = 0;
    for (int i = 0; i < weights.k; ++i) {
      age += i * weights.alpha[static_cast<std::size_t>(i)];
      sum += weights.alpha[static_cast<std::size_t>(i)];
    }
    // Where a fall and a rise of the filter overlap, the valley between two peaks fills a little.
    EXPECT_NEAR(performance_of(felt).delay_vox, age / sum, 0.25) << felt.name;
  }
}

}  // namespace
}  // namespace vicinity::report
