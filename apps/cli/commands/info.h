// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity info: what is in a field.
#pragma once

#include <filesystem>
#include <ostream>

namespace vicinity::cli {

struct InfoOptions {
  std::filesystem::path field;
  bool json = false;
};

/// @return 0
/// Errors: throws Error for a file that is no whole, undamaged field.
int info(const InfoOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
