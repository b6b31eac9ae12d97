// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity export: a field for numpy, OpenVDB or ParaView.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

namespace vicinity::cli {

struct ExportOptions {
  std::filesystem::path field;
  std::filesystem::path output;  ///< .npy, .vdb or .vti
  std::string
      what;  ///< "rank", "viscosity", "object", "distance"; empty: rank (.vdb: viscosity too)
  std::string box;  ///< "x,y,z,x,y,z" [m]; empty: the whole workspace
};

/// @return 0
/// Errors: throws Error for a file that is no field, and for an export too large to be meant.
int export_field(const ExportOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
