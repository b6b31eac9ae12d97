// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/csv_table.h"

#include <algorithm>
#include <utility>

#include "vicinity/geometry/error.h"

namespace vicinity::cli {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string_view unquoted(std::string_view cell) {
  const bool quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return quoted ? trimmed(cell.substr(1, cell.size() - 2)) : cell;
}

}  // namespace

CsvTable::CsvTable(const std::string& where, std::string text) : text_(std::move(text)) {
  if (text_.starts_with(byte_order_mark)) at_ = byte_order_mark.size();
  // The separator is what the first line with anything in it has most of.
  const std::size_t begin = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
  const std::string_view first =
      std::string_view(text_).substr(begin, text_.find('\n', begin) - begin);
  for (const char candidate : {';', '\t'}) {
    if (std::ranges::count(first, candidate) > std::ranges::count(first, separator_)) {
      separator_ = candidate;
    }
  }
  Line line;
  if (!next(line)) throw Error({.where = where, .what = "the log has no header"});
  header_.assign(line.cells.begin(), line.cells.end());
}

bool CsvTable::next(Line& line) {
  while (at_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view text = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    line.number = ++line_;
    if (trimmed(text).empty()) continue;
    split(text, line.cells);
    return true;
  }
  return false;
}

void CsvTable::split(std::string_view text, std::vector<std::string_view>& cells) const {
  cells.clear();
  bool inside_quotes = false;
  std::size_t begin = 0;
  for (std::size_t n = 0; n <= text.size(); ++n) {
    if (n < text.size() && text[n] == '"') inside_quotes = !inside_quotes;
    if (n < text.size() && (text[n] != separator_ || inside_quotes)) continue;
    cells.push_back(unquoted(trimmed(text.substr(begin, n - begin))));
    begin = n + 1;
  }
}

}  // namespace vicinity::cli
