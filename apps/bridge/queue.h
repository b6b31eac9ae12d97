// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// From one thread to another in order, where neither ever waits for the other.
#pragma once

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <ctime>

namespace vicinity::bridge {

/// One giving thread, one taking thread. All memory is there from the start.
template <class T, std::size_t capacity>
class Queue {
 public:
  /// False, and nothing happens, where it is full.
  bool push(const T& value) noexcept {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == capacity) return false;
    places_[end % capacity] = value;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }
  /// False where it is empty.
  bool pop(T& value) noexcept {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return false;
    value = places_[begin % capacity];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }

 private:
  std::array<T, capacity> places_{};
  std::atomic<std::size_t> begin_{0}, end_{0};
};

/// Wakes the thread that takes. A ring while it is awake is not lost.
class Bell {
 public:
  Bell() : event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  ~Bell() { close(event_); }
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;

  void ring() noexcept { (void)!eventfd_write(event_, 1); }
  /// Until it has been rung, at most so long.
  void wait(std::int64_t longest_ns) noexcept {
    pollfd waiting{.fd = event_, .events = POLLIN, .revents = 0};
    const std::int64_t ns = std::max<std::int64_t>(longest_ns, 0);
    const std::timespec longest{.tv_sec = ns / 1'000'000'000, .tv_nsec = ns % 1'000'000'000};
    eventfd_t rings = 0;
    if (ppoll(&waiting, 1, &longest, nullptr) > 0) (void)!eventfd_read(event_, &rings);
  }

 private:
  int event_;
};

}  // namespace vicinity::bridge
