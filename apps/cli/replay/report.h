// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Lines of words under headings, for people.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>
#include <utility>

namespace vicinity::cli {

/// "heading   words", headings in a column of their own.
class Report {
 public:
  template <class... Arguments>
  void line(std::string_view heading, fmt::format_string<Arguments...> words,
            Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), "{:<10}", heading);
    fmt::format_to(std::back_inserter(text_), words, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }
  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

}  // namespace vicinity::cli
