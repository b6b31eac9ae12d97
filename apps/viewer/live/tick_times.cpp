// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "live/tick_times.h"

#include <algorithm>

namespace vicinity::viewer {

TickTimes::TickTimes(std::size_t per_second)
    : took_(per_second, 0.f), late_(per_second, 0.f), sorted_(per_second, 0.f) {}

void TickTimes::add(float took_us, float late_us) noexcept {
  const auto edge = std::ranges::upper_bound(edges_us, took_us);
  ++histogram_[static_cast<std::size_t>(edge - edges_us.begin())];
  took_[next_] = took_us;
  late_[next_] = late_us;
  next_ = (next_ + 1) % took_.size();
  filled_ = std::min(filled_ + 1, took_.size());
}

TickTimes::LastSecond TickTimes::last_second() noexcept {
  if (filled_ == 0) return {};
  const auto count = static_cast<std::ptrdiff_t>(filled_);
  std::copy_n(took_.begin(), count, sorted_.begin());
  const auto at = [&](double share) {
    const auto place =
        sorted_.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(count - 1) + 0.5);
    std::nth_element(sorted_.begin(), place, sorted_.begin() + count);
    return *place;
  };
  return {.p50_us = at(0.5),
          .p99_us = at(0.99),
          .largest_us = *std::max_element(took_.begin(), took_.begin() + count),
          .latest_us = *std::max_element(late_.begin(), late_.begin() + count)};
}

}  // namespace vicinity::viewer
