// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "readable.h"

namespace vicinity::cli {
namespace {

constexpr int width = 32;
// Often enough to look alive, seldom enough to cost nothing.
constexpr auto between_drawings = std::chrono::milliseconds(50);

std::string times(int n, std::string_view text) {
  std::string repeated;
  for (int i = 0; i < n; ++i) repeated += text;
  return repeated;
}

}  // namespace

ProgressBar::ProgressBar(std::ostream& err)
    : err_(err),
      on_terminal_(&err == &std::cerr && isatty(STDERR_FILENO) != 0),
      start_(Clock::now()) {}

ProgressBar::~ProgressBar() {
  if (on_terminal_) err_ << "\r\033[K" << std::flush;
}

void ProgressBar::show(std::string_view label, double done) {
  if (!on_terminal_) return;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (label == last_label_ && now - last_ < between_drawings) return;
  last_ = now;
  last_label_ = label;
  const double share = std::clamp(done, 0.0, 1.0);
  const int full = static_cast<int>(share * width);
  err_ << fmt::format("\r\033[K  {}\033[2m{}\033[0m {:3.0f} %  {}  {}", times(full, "━"),
                      times(width - full, "━"), 100 * share, label,
                      seconds(std::chrono::duration<double>(now - start_).count()))
       << std::flush;
}

}  // namespace vicinity::cli
