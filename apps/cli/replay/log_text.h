// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A log of joints as text in columns, whatever file it comes from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vicinity::cli {

struct LogText {
  std::string csv;
  std::vector<std::string> remarks = {};  ///< what is odd about the file, one sentence each
};

/// The file as it stands; of an MCAP recording (.mcap) its joint states, as mcap_as_csv().
/// Errors: throws Error for a file that is empty or cannot be read, and as mcap_as_csv().
LogText read_log_text(const std::filesystem::path& path);

}  // namespace vicinity::cli
