// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A browser without a window, spoken to over a pipe (Chrome's DevTools protocol).
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vicinity::viewer {

class Browser {
 public:
  /// Starts it. Errors: throws Error where it cannot be started.
  explicit Browser(const std::filesystem::path& program);
  /// Ends it, and removes its profile.
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens a page. Errors: as call().
  void open(const std::string& address, int width, int height);

  /// Asks for something, and waits for the answer. Errors: throws Error where the browser refuses,
  /// has ended, or does not answer within five minutes.
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters);

  /// The value of an expression in the page; null where it has none.
  nlohmann::json evaluate(const std::string& expression);

  /// What the page's console has said so far, one line each.
  const std::vector<std::string>& console() const noexcept { return console_; }

 private:
  nlohmann::json read_message();
  void hear(const nlohmann::json& event);

  std::filesystem::path profile_;
  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
  int calls_ = 0;
  std::string session_, read_;
  std::vector<std::string> console_;
};

}  // namespace vicinity::viewer
