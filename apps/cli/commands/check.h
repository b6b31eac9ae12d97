// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity check: what is wrong with a mesh, in words.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

namespace vicinity::cli {

struct CheckOptions {
  std::filesystem::path mesh;
  std::string units;  ///< "mm", "cm", "m", "in"; empty: not said
  bool json = false;
};

/// @return 0, or 2 for a mesh that cannot be used
/// Errors: throws Error for a file that cannot be read, and for a unit that is none.
int check(const CheckOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
