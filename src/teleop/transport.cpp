// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/transport.h"

#include <cmath>
#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {

std::size_t checked_capacity(const TransportOptions& options, double messages_per_second) {
  const auto demand = [](bool good, const char* what, double found, const char* expected) {
    if (good) return;
    throw Error({.where = "transport",
                 .what = std::string(what) + " cannot be used",
                 .found = std::to_string(found),
                 .expected = expected});
  };
  const auto time = [](double t) { return t >= 0 && std::isfinite(t); };
  demand(time(options.delay_s), "the delay", options.delay_s, "zero or more seconds");
  demand(time(options.jitter_s), "the jitter", options.jitter_s, "zero or more seconds");
  demand(options.loss >= 0 && options.loss <= 1, "the loss", options.loss, "a share, 0 to 1");
  demand(messages_per_second > 0 && std::isfinite(messages_per_second), "the rate",
         messages_per_second, "more than zero messages a second");
  const double most = (options.delay_s + options.jitter_s) * messages_per_second + 2;
  demand(most <= 1e6, "the number of messages under way", most, "at most a million");
  return static_cast<std::size_t>(std::ceil(most));
}

}  // namespace vicinity
