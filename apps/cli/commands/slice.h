// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity slice: a picture of the layers.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

namespace vicinity::cli {

struct SliceOptions {
  std::filesystem::path field;
  std::optional<double> x, y, z;  ///< one of them: where the plane crosses that axis [m]
  std::string box;                ///< "x,y,z,x,y,z" [m]: only this part; empty: all
  std::filesystem::path output;   ///< .png or .svg
};

/// @return 0
/// Errors: throws Error for a file that is no field, for none or several planes, and for a plane
/// outside the workspace or the box.
int slice(const SliceOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
