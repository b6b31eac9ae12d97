// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Whole trials on the gantry: who touches, what gives energy, and that a seed is a seed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "simulation/gantry.h"
#include "simulation/study.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

using testing::HasSubstr;

// Under the sanitizers a trial takes several times as long: one of the paper's and one of ours then
// stand for all, because their code is the same.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::array drags = {"all_II_fading", "rising"};
constexpr std::array prompt_drags = {"all_I_none", "rising"};
#else
constexpr std::array drags = {"all_I_none", "all_II_fading", "closing", "distance", "rising"};
constexpr std::array prompt_drags = {"all_I_none", "closing", "distance", "rising"};
#endif

std::vector<Task> fitted() {
  std::vector<Task> tasks = block_tasks();
  fit_tasks(block_workplace(), tasks, 1);
  return tasks;
}

Method with(const char* name, double setting) {
  Method method = method_named(name);
  method.setting = setting;
  return method;
}

Condition delayed(double delay_s, Placement placement = Placement::remote) {
  Condition condition;
  condition.delay_s = delay_s;
  condition.placement = placement;
  return condition;
}

// Mean speed of the touches, and how many there were.
std::pair<double, int> touches(const Task& task, const Method& method, int trials) {
  Trial trial(block_workplace(), task, method, {});
  const Training trained = trial.train();
  double speed = 0;
  int count = 0;
  for (std::uint64_t n = 0; n < static_cast<std::uint64_t>(trials); ++n) {
    const TrialResult result = trial.run(seed_for(5, n), trained);
    speed += result.impact_speed;
    count += result.touched ? 1 : 0;
  }
  return {speed / std::max(count, 1), count};
}

TEST(Trial, TheSameSeedIsTheSameTrialToTheBitAfterWhateverElse) {
  const std::vector<Task> tasks = fitted();
  Trial trial(block_workplace(), tasks[0], with("rising", 300), delayed(0.03));
  const Training trained = trial.train();
  const TrialResult first = trial.run(17, trained);
  trial.run(18, trained);
  const TrialResult again = trial.run(17, trained);
  EXPECT_EQ(first.time_s, again.time_s);
  EXPECT_EQ(first.effort, again.effort);
  EXPECT_EQ(first.clearance_m, again.clearance_m);
  EXPECT_EQ(first.overshoot_m, again.overshoot_m);
  EXPECT_EQ(first.given_j, again.given_j);
  EXPECT_NE(first.effort, trial.run(18, trained).effort) << "another hand";
}

TEST(Trial, WithoutAnAidTheBlindTouchAndSayHowHard) {
  const std::vector<Task> tasks = fitted();
  Trial trial(block_workplace(), tasks[0], with("none", 0), {});
  int hits = 0;
  for (std::uint64_t n = 0; n < 40; ++n) {
    const TrialResult result = trial.run(seed_for(5, n), {});
    EXPECT_FALSE(result.blew_up);
    EXPECT_TRUE(result.finished);
    hits += result.touched ? 1 : 0;
    EXPECT_EQ(result.touched, result.peak_force > 0);
    if (result.touched) {
      EXPECT_LT(result.clearance_m, 0.02);
    }
  }
  // A depth error of 20 mm beside a gap of 20 mm, and a little noise: some, and not all.
  EXPECT_GT(hits, 2);
  EXPECT_LT(hits, 25);
}

// Not rarer: the hand still goes where the eye says. But what touches has lost its speed, where no
// memory holds the rise back: with all_II_fading more than half of it is left.
TEST(Trial, WithPromptDragATouchIsAQuarterAsFast) {
  const std::vector<Task> tasks = fitted();
  const auto [speed, count] = touches(tasks[0], with("none", 0), 30);
  ASSERT_GT(count, 5);
  for (const char* name : prompt_drags) {
    EXPECT_LT(touches(tasks[0], with(name, 300), 30).first, 0.25 * speed) << name;
  }
}

// A spring that is stiff enough keeps the hand off, as long as nothing is late.
TEST(Trial, AStiffVirtualFixtureTouchesLessThanNone) {
  const std::vector<Task> tasks = fitted();
  EXPECT_LT(2 * touches(tasks[0], with("virtual_fixture", 800), 30).second,
            touches(tasks[0], with("none", 0), 30).second);
}

TEST(Trial, RetreatIsFreeWithClosingAndNotWithThePapersDrag) {
  const std::vector<Task> tasks = fitted();
  const auto effort = [&](const Method& method) {
    Trial trial(block_workplace(), tasks[1], method, {});
    return trial.run(1, {method.cue, 0}).effort;
  };
  const double none = effort(with("none", 0));
  EXPECT_LT(effort(with("closing", 2000)), 1.05 * none);
  EXPECT_GT(effort(with("all_II_none", 2000)), 1.2 * none);
}

// Must hold: no configuration in strict mode puts energy into the hand at any delay tried.
TEST(Energy, StrictGivesNoneBeyondWhatTheDeviceEats) {
  const std::vector<Task> tasks = fitted();
  for (const char* name : drags) {
    for (const double delay_s : {0.0, 0.02, 0.05, 0.1, 0.2}) {
      for (const Placement placement : {Placement::local, Placement::remote}) {
        Method method = with(name, 5000);
        method.mode = LimiterMode::strict;
        Condition condition = delayed(delay_s, placement);
        if (placement == Placement::remote) {
          condition.jitter_s = 0.005;
          condition.loss = 0.1;
        }
        Trial trial(block_workplace(), tasks[0], method, condition);
        const TrialResult result = trial.run(seed_for(9, 1), {method.cue, 0});
        EXPECT_LT(result.given_beyond_device_j, 1e-9)
            << name << ' ' << delay_s << ' ' << to_string(placement);
      }
    }
  }
}

// And the force field does.
TEST(Energy, ADelayedForceFieldGivesMoreThanItHadTaken) {
  const std::vector<Task> tasks = fitted();
  for (const double delay_s : {0.05, 0.1, 0.2}) {
    double most = 0;
    Trial trial(block_workplace(), tasks[0], with("virtual_fixture", 800), delayed(delay_s));
    for (std::uint64_t n = 0; n < 10; ++n) {
      most = std::max(most, trial.run(seed_for(5, n), {Cue::force, 0}).given_j);
    }
    EXPECT_GT(most, 1e-3) << delay_s;
  }
}

TEST(Study, DependsOnItsSeedAndNotOnThreads) {
  const std::vector<Task> tasks = fitted();
  StudyOptions options;
  options.trials = 6;
  options.tuning_trials = 2;
  options.methods = {"none", "closing"};
  options.delays_s = {0.05};
  const auto efforts = [&] {
    std::vector<double> all;
    for (const CellResult& cell : run_study(block_workplace(), tasks, options).cells) {
      for (const TrialResult& trial : cell.trials) all.push_back(trial.effort);
    }
    return all;
  };
  options.threads = 1;
  const std::vector<double> one = efforts();
  options.threads = 2;
  EXPECT_EQ(one, efforts());
  options.seed = 2;
  EXPECT_NE(one, efforts());
}

TEST(Study, RefusesUnknownMethodsWithTheNearest) {
  StudyOptions options;
  options.methods = {"risng"};
  try {
    run_study(block_workplace(), fitted(), options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("rising"));
  }
}

TEST(Tasks, AWayThatTheArmCannotGoIsNamed) {
  std::vector<Task> tasks = block_tasks();
  tasks[1].intent.path_W[1].z() = -0.1;  // into the block
  try {
    fit_tasks(block_workplace(), tasks, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("retreat"));
  }
}

TEST(Tasks, RefusesWhatIsNoTaskWithItsLine) {
  for (const char* text :
       {"", "tasks: []", "tasks: [1]", "tasks:\n  - {name: a}",
        "tasks:\n  - {name: a, path: [[0, 0, 0]]}",
        "tasks:\n  - {name: a, path: [[0, 0, 0], [0, 0, x]]}",
        "tasks:\n  - {name: a, path: [[0, 0, 0], [0, 0, 1]], sped: 1}",
        "tasks:\n  - {name: a, path: [[0, 0, 0], [0, 0, 1]], speed: 0}", "tasks: [",
        "tasks:\n  - {name: a, path: [[0,0,0],[0,0,1]], points: [0,0,0]}"}) {
    EXPECT_THROW(parse_tasks(text, "t.yaml"), Error) << text;
  }
}

TEST(Estimate, WilsonAndStudentAgreeWithTables) {
  const Estimate none = share_of(0, 200);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 0.01885, 1e-4);
  const Estimate half = share_of(100, 200);
  EXPECT_NEAR(half.low, 0.4313, 1e-4);
  // t(0.975; 9) = 2.2622
  const Estimate mean = mean_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  EXPECT_NEAR(mean.high - mean.value, 2.2622 * 3.02765 / std::sqrt(10.0), 0.01);
}

}  // namespace
}  // namespace vicinity
