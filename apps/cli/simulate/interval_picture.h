// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Shares with their ranges as dots and whiskers, one row an aid, one column a task.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simulation/estimate.h"

namespace vicinity::cli {

struct IntervalColumn {
  std::string title;
  double most = 1;             ///< right end of the axis
  std::vector<Estimate> rows;  ///< one for each row name
  std::vector<bool> there;     ///< whether there is a number
};

/// Draws to .png or .svg. Errors: throws Error for another extension, or a file that cannot be
/// written.
void draw_intervals(const std::vector<std::string>& rows,
                    const std::vector<IntervalColumn>& columns, const std::filesystem::path& path);

}  // namespace vicinity::cli
