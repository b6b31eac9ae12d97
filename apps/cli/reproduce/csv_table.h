// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Numbers on their way into a CSV file.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <type_traits>

#include "fresh_file.h"

namespace vicinity::report {

class CsvTable {
 public:
  /// @param header  "y,z,drag_N": names with their units
  explicit CsvTable(std::string header) : text_(std::move(header) + '\n') {}

  /// Ten digits of a number, as the traces of the program have them; words have no comma in them.
  template <class... Cells>
  void row(const Cells&... cells) {
    const char* comma = "";
    ((text_ += comma, text_ += cell(cells), comma = ","), ...);
    text_ += '\n';
  }

  void write(const std::filesystem::path& path) const {
    cli::FreshFile file(path);
    file.write(text_);
    file.commit();
  }

 private:
  template <class Cell>
  static std::string cell(const Cell& value) {
    if constexpr (std::is_floating_point_v<Cell>) {
      return fmt::format("{:.10g}", value + 0.0);  // no "-0"
    } else {
      return fmt::format("{}", value);
    }
  }

  std::string text_;
};

}  // namespace vicinity::report
