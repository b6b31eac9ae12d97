// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Names of the files that a command writes, looked at before any work is done.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace vicinity::cli {

struct Output {
  std::string_view option;     ///< that named it: "-o"
  std::filesystem::path path;  ///< empty: not asked for
};

/// @param inputs  files that the command reads; empty ones are left out
/// Errors: throws Error for an output that is one of the inputs or another output, by whatever
/// name, and where there is something that is no regular file.
void check_outputs(const std::vector<Output>& outputs,
                   const std::vector<std::filesystem::path>& inputs);

}  // namespace vicinity::cli
