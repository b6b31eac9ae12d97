// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Wherever memory runs out, a build says so, and nothing else comes of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <optional>

#include "failing_memory.h"
#include "random_scene.h"
#include "rounds.h"
#include "seeds.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

using test::FailingMemory;
using test::for_each_seed;
using test::random_scene;
using test::whole;

constexpr auto never = static_cast<std::size_t>(-1);

class OutOfMemory : public testing::TestWithParam<FailingMemory::Refuses> {};

TEST_P(OutOfMemory, ABuildThrowsBadAllocAndTheNextOneIsWhole) {
  for_each_seed(test::rounds(6U), [](std::mt19937& random) {
    const Scene scene = random_scene(random, 4, 40);
    std::size_t requests = 0;
    std::optional<BuildResult> expected;
    {
      const FailingMemory memory(never, FailingMemory::Refuses::one);
      expected = build_field(scene);
      requests = memory.requests();
    }
    FieldBuilder builder;
    int refused = 0;
    for (int attempt = 0; attempt < 40; ++attempt) {
      // Half of them among the first requests, before the threads set out.
      const double part = test::real(random, 0, 1);
      const auto request = static_cast<std::size_t>((attempt % 2 == 0 ? part : part * part * part) *
                                                    static_cast<double>(requests));
      SCOPED_TRACE("request " + std::to_string(request) + " of about " + std::to_string(requests));
      try {
        const FailingMemory memory(request, GetParam());
        build_field(scene);
        // How many requests there are depends on how the threads share the work.
        EXPECT_TRUE(memory.requests() <= request || GetParam() == FailingMemory::Refuses::one);
      } catch (const std::bad_alloc&) {
        ++refused;
      }
      // A builder that has seen the like keeps nothing of it.
      try {
        const FailingMemory memory(request, GetParam());
        builder.build(scene);
      } catch (const std::bad_alloc&) {
      }
      const BuildResult whole = builder.build(scene);
      ASSERT_TRUE(std::ranges::equal(whole.field.image(), expected->field.image()));
    }
    EXPECT_GT(refused, 20);
  });
}

INSTANTIATE_TEST_SUITE_P(, OutOfMemory,
                         testing::Values(FailingMemory::Refuses::one,
                                         FailingMemory::Refuses::all_from_then_on),
                         [](const auto& refuses) {
                           return refuses.param == FailingMemory::Refuses::one
                                      ? "OneRequestIsRefused"
                                      : "AllAreRefusedFromThenOn";
                         });

}  // namespace
}  // namespace vicinity
