// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What the bridge was given to make its field from, and whether it has changed on disk.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::bridge {

/// Whether it is a scene, by its ending: .yaml, .yml.
bool is_scene(const std::filesystem::path& input);

/// A scene, with its mesh files, or a field file.
class WatchedInput {
 public:
  explicit WatchedInput(std::filesystem::path input);

  const std::filesystem::path& path() const noexcept { return input_; }

  /// Builds the scene, again only what changed, or reads the field into memory.
  /// Errors: throws Error for one that cannot be used; it is not changed() until it is written
  /// anew.
  ViscosityField field(const BuildOptions& options = {});

  /// Whether a file is another than at the last field(), and has been for one call at least:
  /// whoever writes it has most likely finished.
  bool changed();

 private:
  // Time and size of every file; a file that is not there has neither.
  using Look = std::vector<std::pair<std::filesystem::file_time_type, std::uintmax_t>>;
  Look look() const;

  std::filesystem::path input_;
  std::vector<std::filesystem::path> files_;
  FieldBuilder builder_;
  Look used_, last_;
};

}  // namespace vicinity::bridge
