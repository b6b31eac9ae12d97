// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// How much memory a piece of code asks for: this test program counts in operator new.
#pragma once

#include <cstddef>

namespace vicinity {

/// Counts what this thread allocates while it lives.
class AllocationMeter {
 public:
  AllocationMeter();
  ~AllocationMeter();
  AllocationMeter(const AllocationMeter&) = delete;
  AllocationMeter& operator=(const AllocationMeter&) = delete;

  std::size_t largest() const;  ///< largest single request [bytes]
  std::size_t peak() const;     ///< most bytes held at one time
};

}  // namespace vicinity
