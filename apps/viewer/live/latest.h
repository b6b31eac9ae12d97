// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The newest value of something, from one thread to another, where neither ever waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace vicinity::viewer {

/// Three places: one that is written, one that is read, and one between them that changes hands
/// whole. The reader gets the newest value that was given, and never half of one; values that
/// nobody took are lost. One writing thread, one reading thread.
template <class T>
class Latest {
 public:
  /// All three places hold a copy, so that none has to take memory later.
  explicit Latest(const T& first = T{}) : places_{first, first, first} {}

  /// What to fill next; holds some older value. For the writing thread.
  T& to_fill() noexcept { return places_[writes_]; }
  /// Hands over what was filled.
  void give() noexcept {
    writes_ =
        between_.exchange(static_cast<std::uint8_t>(writes_ | fresh), std::memory_order_acq_rel) &
        place;
  }

  /// Takes what has been given since the last call; false where nothing has. For the reading
  /// thread.
  bool take() noexcept {
    if ((between_.load(std::memory_order_relaxed) & fresh) == 0) return false;
    reads_ = between_.exchange(reads_, std::memory_order_acq_rel) & place;
    return true;
  }
  /// What was taken last.
  const T& taken() const noexcept { return places_[reads_]; }

 private:
  static constexpr std::uint8_t place = 3, fresh = 4;

  std::array<T, 3> places_;
  std::uint8_t writes_ = 0, reads_ = 1;
  std::atomic<std::uint8_t> between_{2};
};

}  // namespace vicinity::viewer
