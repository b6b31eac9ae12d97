// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/real_time.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace vicinity::cli {
namespace {

// Above everything but the kernel's own threads of highest priority.
constexpr int fifo_priority = 80;
constexpr std::int64_t ns_per_s = 1'000'000'000;

// Touches as much of the stack as a tick can need, so that it is there when memory is locked.
void touch_stack() noexcept {
  constexpr std::size_t bytes = 256 * 1024;
  volatile char stack[bytes];
  for (std::size_t n = 0; n < bytes; n += 4096) stack[n] = 0;
  (void)stack[0];
}

}  // namespace

RealTime::RealTime() {
  pin_to_one_processor();
  schedule_before_others();
  lock_memory();
  // Without SCHED_FIFO the kernel rounds wake-ups to 50 µs unless asked not to.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

RealTime::~RealTime() {
  prctl(PR_SET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL);  // back to the default
  if (locked_) munlockall();
  if (scheduled_) sched_setscheduler(0, policy_before_, &priority_before_);
  if (pinned_) sched_setaffinity(0, sizeof processors_before_, &processors_before_);
}

void RealTime::pin_to_one_processor() {
  // The last one that is allowed: interrupts tend to arrive at the first.
  int last = -1;
  if (sched_getaffinity(0, sizeof processors_before_, &processors_before_) == 0) {
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (CPU_ISSET(cpu, &processors_before_)) last = cpu;
    }
  }
  cpu_set_t one;
  CPU_ZERO(&one);
  if (last >= 0) CPU_SET(last, &one);
  pinned_ = last >= 0 && sched_setaffinity(0, sizeof one, &one) == 0;
  words_.push_back(pinned_ ? fmt::format("pinned to processor {}", last)
                           : fmt::format("not pinned to a processor: {}", std::strerror(errno)));
}

void RealTime::schedule_before_others() {
  policy_before_ = sched_getscheduler(0);
  sched_getparam(0, &priority_before_);
  const sched_param priority{.sched_priority = fifo_priority};
  scheduled_ = sched_setscheduler(0, SCHED_FIFO, &priority) == 0;
  words_.push_back(
      scheduled_
          ? fmt::format("SCHED_FIFO, priority {}", fifo_priority)
          : fmt::format("no SCHED_FIFO: {}; root, or a limit 'rtprio {}' for this user, allows it",
                        std::strerror(errno), fifo_priority));
}

void RealTime::lock_memory() {
  touch_stack();
  // Only what is there: a tick takes none, and with MCL_FUTURE a limit would make other threads'
  // requests for memory fail.
  locked_ = mlockall(MCL_CURRENT) == 0;
  words_.push_back(locked_ ? "memory locked"
                           : fmt::format("memory not locked: {}; root, or a larger limit 'memlock' "
                                         "for this user, allows it",
                                         std::strerror(errno)));
}

std::int64_t monotonic_ns() noexcept {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * ns_per_s + now.tv_nsec;
}

void sleep_until(std::int64_t monotonic_ns) noexcept {
  const timespec then{.tv_sec = monotonic_ns / ns_per_s, .tv_nsec = monotonic_ns % ns_per_s};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &then, nullptr);
}

ProcessUse process_use() noexcept {
  ProcessUse use;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
    unsigned long pages = 0, resident = 0;
    if (std::fscanf(file, "%lu %lu", &pages, &resident) == 2) {
      use.resident_bytes = resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    }
    std::fclose(file);
  }
  rusage thread{};
  if (getrusage(RUSAGE_THREAD, &thread) == 0) {
    use.page_faults = static_cast<std::uint64_t>(thread.ru_minflt + thread.ru_majflt);
    use.preemptions = static_cast<std::uint64_t>(thread.ru_nivcsw);
  }
  return use;
}

}  // namespace vicinity::cli
