// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Memory that runs out when a test says so: this test program has an operator new of its own.
#pragma once

#include <cstddef>

namespace vicinity::test {

/// While it lives, one request of operator new is refused, by whichever thread it is made, or that
/// one and all after it. Small requests count for nothing, and are met: so it is where memory runs
/// out, and nlohmann_json, which takes memory in a destructor, would end the program.
class FailingMemory {
 public:
  static constexpr std::size_t small_request = 4096;  ///< [bytes]
  enum class Refuses { one, all_from_then_on };
  /// @param request  from 0
  FailingMemory(std::size_t request, Refuses refuses);
  ~FailingMemory();
  FailingMemory(const FailingMemory&) = delete;
  FailingMemory& operator=(const FailingMemory&) = delete;

  /// Requests of all threads since it was made.
  std::size_t requests() const;
};

}  // namespace vicinity::test
