// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "geometry/whole_loops.h"

#include <gtest/gtest.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <new>
#include <numeric>
#include <thread>
#include <vector>

namespace vicinity {
namespace {

void wait_until(const std::atomic<bool>& flag) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!flag && std::chrono::steady_clock::now() < end) std::this_thread::yield();
}

/// Of two threads' parts, one throws while the other is in a loop of its own.
/// @return whether `loop`, which must call its argument, came back as if it was done
template <class Loop>
bool comes_back_when_given_up(const Loop& loop) {
  const tbb::global_control two_threads(tbb::global_control::max_allowed_parallelism, 2);
  std::atomic<bool> within = false, thrown = false, back = false;
  tbb::task_group_context outer;
  EXPECT_THROW(tbb::parallel_for(
                   0, 2,
                   [&](int part) {
                     if (part == 1) {
                       wait_until(within);
                       thrown = true;
                       throw std::bad_alloc();
                     }
                     loop([&] {
                       within = true;
                       wait_until(thrown);
                       // The context is given up a moment after the throw.
                       const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
                       while (!outer.is_group_execution_cancelled() &&
                              std::chrono::steady_clock::now() < end) {
                         std::this_thread::yield();
                       }
                     });
                     back = true;
                   },
                   tbb::simple_partitioner(), outer),
               std::bad_alloc);
  EXPECT_TRUE(within);
  return back;
}

TEST(WholeLoops, NoneComesBackWhenTheLoopAroundItIsGivenUp) {
  using Range = tbb::blocked_range<int>;
  // That TBB's own does is why these exist.
  EXPECT_TRUE(comes_back_when_given_up(
      [](const auto& call) { tbb::parallel_for(0, 1000, [&](int) { call(); }); }));
  EXPECT_FALSE(comes_back_when_given_up(
      [](const auto& call) { whole::parallel_for(0, 1000, [&](int) { call(); }); }));
  EXPECT_FALSE(comes_back_when_given_up([](const auto& call) {
    whole::parallel_reduce(
        Range(0, 1000), 0,
        [&](const Range&, int sum) {
          call();
          return sum;
        },
        std::plus<>());
  }));
  EXPECT_FALSE(comes_back_when_given_up([](const auto& call) {
    int next = 0;
    whole::parallel_pipeline(
        2, tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order,
                                       [&](tbb::flow_control& flow) {
                                         if (next == 1000) flow.stop();
                                         return next++;
                                       }) &
               tbb::make_filter<int, void>(tbb::filter_mode::parallel, [&](int) { call(); }));
  }));
}

TEST(WholeLoops, AreThoseOfTbbOtherwise) {
  std::vector<int> values(10'000);
  whole::parallel_for(0, 10'000, [&](int n) { values[static_cast<std::size_t>(n)] = n; });
  using Range = tbb::blocked_range<std::size_t>;
  const long sum = whole::parallel_reduce(
      Range(0, values.size()), 0L,
      [&](const Range& range, long before) {
        for (std::size_t n = range.begin(); n < range.end(); ++n) before += values[n];
        return before;
      },
      std::plus<>());
  EXPECT_EQ(sum, std::accumulate(values.begin(), values.end(), 0L));
  EXPECT_THROW(whole::parallel_for(0, 10, [](int) { throw std::bad_alloc(); }), std::bad_alloc);
}

}  // namespace
}  // namespace vicinity
