// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "interruption.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace vicinity::cli {
namespace {

constexpr int exit_code = 128 + SIGINT;  // as a shell reports it

// A signal may arrive in any thread.
std::atomic<int> writers = 0, asked = 0;
static_assert(std::atomic<int>::is_always_lock_free, "else a signal could wait for itself");

// Only async-signal-safe calls in here.
void on_signal(int) {
  if (writers > 0 && asked == 0) {
    asked = 1;
    return;
  }
  _exit(exit_code);
}

}  // namespace

void catch_interruptions() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

WhileWriting::WhileWriting() noexcept { ++writers; }

WhileWriting::~WhileWriting() {
  if (--writers == 0 && asked != 0) _exit(exit_code);
}

UntilAsked::UntilAsked() noexcept { ++writers; }

UntilAsked::~UntilAsked() {
  --writers;
  asked = 0;
}

bool interruption_asked() noexcept { return asked != 0; }

void stop_if_interrupted() {
  if (interruption_asked()) throw Interrupted();
}

}  // namespace vicinity::cli
