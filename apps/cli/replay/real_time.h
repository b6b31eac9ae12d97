// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a thread that must not be late can ask of the system, and whether it was granted.
#pragma once

#include <sched.h>
#include <time.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vicinity::cli {

/// While it lives, the thread that made it is on one processor, scheduled before all others
/// (SCHED_FIFO), and nothing the process holds by now can be paged out. What is refused is done
/// without. Threads started later would inherit the first two: start them before.
class RealTime {
 public:
  RealTime();
  ~RealTime();
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;

  /// One sentence for each thing asked for: granted, or why not and what to try.
  const std::vector<std::string>& words() const noexcept { return words_; }

 private:
  void pin_to_one_processor();
  void schedule_before_others();
  void lock_memory();

  std::vector<std::string> words_;
  cpu_set_t processors_before_{};
  int policy_before_ = SCHED_OTHER;
  sched_param priority_before_{};
  bool pinned_ = false, scheduled_ = false, locked_ = false;
};

/// Nanoseconds on the clock that nobody sets (CLOCK_MONOTONIC).
std::int64_t monotonic_ns() noexcept;

/// Sleeps until then; sooner if a signal comes.
void sleep_until(std::int64_t monotonic_ns) noexcept;

/// What the system has done to the process so far.
struct ProcessUse {
  std::uint64_t resident_bytes = 0;  ///< memory that is not paged out
  std::uint64_t page_faults = 0;     ///< of this thread
  std::uint64_t preemptions = 0;     ///< times this thread was put aside for another
};
ProcessUse process_use() noexcept;

}  // namespace vicinity::cli
