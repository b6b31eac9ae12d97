// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity build: a scene, or one mesh, into a field on disk.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

namespace vicinity::cli {

/// What is given here wins over what the scene says, for every object of the scene.
struct BuildOptions {
  std::filesystem::path input;   ///< .yaml or .yml: a scene; anything else: one mesh
  std::filesystem::path output;  ///< the field
  std::filesystem::path meshes;  ///< where relative mesh paths start; empty: beside the scene
  std::string units;             ///< of a single mesh: "mm", "cm", "m", "in"
  std::optional<double> voxel_size, skin;
  std::optional<int> m, q;
  std::optional<std::string> shape, coding, boundary, inner, bounds;
  int threads = 0;  ///< 0: as many as the machine has
  bool json = false;
};

/// @return 0
/// Errors: throws Error for input that cannot be built from.
int build(const BuildOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
