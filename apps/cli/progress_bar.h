// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A progress bar for people who watch.
#pragma once

#include <chrono>
#include <mutex>
#include <ostream>
#include <string>
#include <string_view>

namespace vicinity::cli {

/// Draws one line over and over on a terminal, and nothing at all elsewhere (a file, a pipe), so
/// that logs stay clean. Erased when it goes.
class ProgressBar {
 public:
  explicit ProgressBar(std::ostream& err);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param label  what is going on, a word or two
  /// @param done   0..1
  /// May be called from any thread.
  void show(std::string_view label, double done);

 private:
  using Clock = std::chrono::steady_clock;

  std::ostream& err_;
  bool on_terminal_;
  std::mutex mutex_;
  Clock::time_point start_, last_;
  std::string last_label_;
};

}  // namespace vicinity::cli
