// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// How many random rounds a property test goes through.
#pragma once

namespace vicinity::test {

/// All of them, or a quarter under sanitizers, which make each round five to ten times as long:
/// they watch what code does with memory, and the first rounds reach the same code as the last.
/// That the property holds, the plain build's rounds show.
template <class Count>
constexpr Count rounds(Count all) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return (all + 3) / 4;
#else
  return all;
#endif
}

}  // namespace vicinity::test
