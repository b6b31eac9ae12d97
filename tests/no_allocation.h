// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Fails the test in whose scope memory is taken from the heap.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>

namespace vicinity {

/// Calls of malloc and its kin in this thread so far: Eigen does not go through operator new. Stays
/// zero in builds with a sanitizer that needs malloc for itself.
std::size_t allocation_count() noexcept;

class NoAllocation {
 public:
  ~NoAllocation() { EXPECT_EQ(allocation_count(), before_) << "memory was taken from the heap"; }

 private:
  std::size_t before_ = allocation_count();
};

}  // namespace vicinity
