// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity query: what is at a point.
#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

namespace vicinity::cli {

struct QueryOptions {
  std::filesystem::path field;
  std::vector<double> point;  ///< x, y, z [m]; empty: lines x,y,z on standard input
  bool json = false;
};

/// One point: a sentence, or with `json` one object with kind, object, rank, viscosity, distance
/// [m] (null where not kept) and inside (of the workspace). Points on standard input: CSV with the
/// same columns, or with `json` one object a line.
/// @return 0
/// Errors: throws Error for a file that is no field and for a line that is no point.
int query(const QueryOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
