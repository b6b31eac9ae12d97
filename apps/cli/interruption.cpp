// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "interruption.h"

#include <unistd.h>

#include <csignal>

namespace vicinity::cli {
namespace {

constexpr int exit_code = 128 + SIGINT;  // as a shell reports it

volatile std::sig_atomic_t writers = 0;
volatile std::sig_atomic_t asked = 0;

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

WhileWriting::WhileWriting() noexcept { writers = writers + 1; }

WhileWriting::~WhileWriting() {
  writers = writers - 1;
  if (writers == 0 && asked != 0) _exit(exit_code);
}

bool interruption_asked() noexcept { return asked != 0; }

void stop_if_interrupted() {
  if (interruption_asked()) throw Interrupted();
}

}  // namespace vicinity::cli
