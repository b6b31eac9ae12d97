// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/handover.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "no_allocation.h"
#include "rounds.h"

namespace vicinity {
namespace {

class Counted {
 public:
  Counted(int number, std::atomic<int>& alive) : number_(number), alive_(alive) { ++alive_; }
  ~Counted() { --alive_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  int number() const { return number_; }

 private:
  int number_;
  std::atomic<int>& alive_;
};

TEST(Handover, WhatIsOfferedLastIsTakenHoweverCloseTheOffersAre) {
  std::atomic<int> alive = 0;
  std::atomic<int> seen = 0;
  std::atomic<bool> over = false;
  const int rounds = test::rounds(100'000);
  {
    Handover<Counted> handover;
    std::thread taker([&] {
      auto in_use = std::make_unique<Counted>(0, alive);
      while (!over) {
        const NoAllocation none;
        if (handover.take(in_use)) seen = in_use->number();
      }
    });
    for (int round = 0; round < rounds; ++round) {
      const int last = 2 * round + 2;
      handover.offer(std::make_unique<Counted>(last - 1, alive));
      handover.offer(std::make_unique<Counted>(last, alive));
      const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
      while (seen != last && std::chrono::steady_clock::now() < end) {
      }
      if (seen != last) {
        ADD_FAILURE() << "round " << round << ": " << seen << " is in use, " << last << " waits";
        break;
      }
      // In use, and given up since the last offer; no heap of those before.
      ASSERT_LE(alive, 4);
    }
    over = true;
    taker.join();
  }
  EXPECT_EQ(alive, 0);
}

TEST(Handover, TakesNothingWhereNothingIsOffered) {
  std::atomic<int> alive = 0;
  Handover<Counted> handover;
  std::unique_ptr<Counted> in_use;
  EXPECT_FALSE(handover.take(in_use));
  EXPECT_EQ(in_use, nullptr);
  handover.offer(std::make_unique<Counted>(1, alive));
  handover.offer(std::make_unique<Counted>(2, alive));
  EXPECT_TRUE(handover.take(in_use));
  EXPECT_EQ(in_use->number(), 2);
  EXPECT_FALSE(handover.take(in_use));
  EXPECT_EQ(in_use->number(), 2);
}

}  // namespace
}  // namespace vicinity
