// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Cells of a CSV file as loggers write it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vicinity::cli {

/// A header and lines of cells. Survives a byte order mark, CRLF, blank lines, blanks around cells,
/// quoted cells, and semicolons or tabs in place of commas (whichever the header has).
class CsvTable {
 public:
  struct Line {
    std::size_t number = 0;               ///< in the file, 1-based
    std::vector<std::string_view> cells;  ///< without blanks and quotes around them
  };

  /// @param where  names the text in errors. Errors: throws Error for a text without a header.
  CsvTable(const std::string& where, std::string text);
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  const std::vector<std::string>& header() const noexcept { return header_; }
  /// Reads the next line that is not blank; false at the end. Its cells stay valid with the table.
  bool next(Line& line);

 private:
  void split(std::string_view text, std::vector<std::string_view>& cells) const;

  std::string text_;
  std::size_t at_ = 0, line_ = 0;
  char separator_ = ',';
  std::vector<std::string> header_;
};

}  // namespace vicinity::cli
