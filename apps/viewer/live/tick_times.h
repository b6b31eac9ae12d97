// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// How long ticks took: all of them as a histogram, those of the last second in numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vicinity::viewer {

class TickTimes {
 public:
  /// Upper edges of all bins but the last, which is open [µs].
  static constexpr std::array<float, 19> edges_us = {1,    2,    5,    10,   20,   50,   100,
                                                     200,  500,  1e3f, 2e3f, 5e3f, 1e4f, 2e4f,
                                                     5e4f, 1e5f, 2e5f, 5e5f, 1e6f};
  static constexpr std::size_t bins = edges_us.size() + 1;

  /// @param per_second  ticks that the last second holds
  explicit TickTimes(std::size_t per_second);

  /// Real-time: no allocation.
  void add(float took_us, float late_us) noexcept;

  struct LastSecond {
    float p50_us = 0, p99_us = 0, largest_us = 0, latest_us = 0;
  };
  /// Real-time: O(ticks in a second), no allocation.
  LastSecond last_second() noexcept;
  const std::array<std::uint32_t, bins>& histogram() const noexcept { return histogram_; }

 private:
  std::array<std::uint32_t, bins> histogram_{};
  std::vector<float> took_, late_, sorted_;
  std::size_t next_ = 0, filled_ = 0;
};

}  // namespace vicinity::viewer
