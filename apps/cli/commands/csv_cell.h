// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A name as one cell of a CSV line (RFC 4180).
#pragma once

#include <string>

namespace vicinity::cli {

/// As it is, or in quotes where it holds a comma, a quote or a line break.
inline std::string csv_cell(const std::string& name) {
  if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
  std::string cell = "\"";
  for (const char c : name) {
    if (c == '"') cell += '"';
    cell += c;
  }
  return cell + '"';
}

}  // namespace vicinity::cli
