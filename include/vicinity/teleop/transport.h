// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The way between master and slave: what is sent arrives later, unevenly, or not at all.
#pragma once

#include <cstdint>
#include <vector>

#include "vicinity/teleop/seeded_noise.h"

namespace vicinity {

struct TransportOptions {
  double delay_s = 0;   ///< of every message, >= 0                         [s]
  double jitter_s = 0;  ///< up to so much more, evenly spread, >= 0        [s]
  double loss = 0;      ///< share of messages that never arrive, 0..1
  std::uint64_t seed = 0;
};

/// Errors: throws Error for times that are negative or not finite, a loss outside 0..1, a rate that
/// is not positive, and more than a million messages under way.
/// @return  messages that may be under way at once
std::size_t checked_capacity(const TransportOptions& options, double messages_per_second);

/// One direction. As datagrams are: a message that was overtaken by a newer one is dropped.
template <class Message>
class Transport {
 public:
  /// Takes all memory. Errors: as checked_capacity().
  Transport(const TransportOptions& options, double messages_per_second)
      : options_(options),
        noise_(options.seed),
        under_way_(checked_capacity(options, messages_per_second)) {}

  /// Real-time: O(1), no allocation.
  void send(double time_s, const Message& message) noexcept {
    const double later = options_.jitter_s > 0 ? options_.jitter_s * noise_.uniform() : 0;
    if (options_.loss > 0 && noise_.uniform() < options_.loss) return;
    if (count_ == under_way_.size()) --count_;  // faster than was said: the oldest makes room
    newest_ = (newest_ + 1) % under_way_.size();
    under_way_[newest_] = {time_s + options_.delay_s + later, message};
    ++count_;
  }

  /// The newest message that is there by now and has not been handed out, or null. Valid until the
  /// next send(). Real-time: time grows with the messages under way; no allocation.
  const Message* receive(double time_s) noexcept {
    // Clocks are sums of periods: what is due now may be due a rounding later.
    constexpr double rounding_s = 1e-9;
    for (std::size_t age = 0; age < count_; ++age) {
      const std::size_t at = (newest_ + under_way_.size() - age) % under_way_.size();
      if (under_way_[at].arrives_s > time_s + rounding_s) continue;
      count_ = age;  // this one and all older ones are done with
      return &under_way_[at].message;
    }
    return nullptr;
  }

  /// Empty, and as random as at the start.
  void restart(std::uint64_t seed) noexcept {
    count_ = 0;
    noise_ = SeededNoise(seed);
  }

 private:
  struct Letter {
    double arrives_s = 0;
    Message message;
  };

  TransportOptions options_;
  SeededNoise noise_;
  std::vector<Letter> under_way_;  // a ring
  std::size_t newest_ = 0, count_ = 0;
};

}  // namespace vicinity
