// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity reproduce: every figure and table of the paper, ours beside theirs.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

namespace vicinity::cli {

struct ReproduceOptions {
  std::filesystem::path folder;
  std::string only;  ///< one item, or one figure that an item shows; empty: all
};

/// Writes index.html, verdicts.json ([{item, agrees, why}]), the parts as STL files in meshes/ and,
/// in a folder for each item, figures and CSV files. Two runs write the same CSV files; what
/// depends on the machine's speed is in files named *_timing.json.
/// @return 0, whatever the verdicts are
/// Errors: throws Error for an item that there is not, and where the folder cannot be written.
int reproduce(const ReproduceOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
