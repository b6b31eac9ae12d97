// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The one folder that pages may put files into and take them from.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vicinity::viewer {

/// Whether a name is plain: letters, digits, '.', '_', '-' and space, no leading dot or space, 1 to
/// 100 characters. Such a name leads nowhere but into the folder it is looked for in.
bool is_plain_name(std::string_view name);

/// Scenes and fields lie in it, meshes and recordings in folders of theirs. Made when the first
/// file comes. Functions that take a name throw Error for one that is not plain or has another
/// ending.
class Folder {
 public:
  explicit Folder(std::filesystem::path path)
      : path_(std::move(path)), scratch_files_(static_cast<std::uint64_t>(now().count())) {}

  const std::filesystem::path& path() const noexcept { return path_; }
  std::filesystem::path scene(const std::string& name) const;      ///< .yaml, .yml
  std::filesystem::path field(const std::string& name) const;      ///< .vicinity
  std::filesystem::path mesh(const std::string& name) const;       ///< .stl, .obj, .ply, ...
  std::filesystem::path recording(const std::string& name) const;  ///< .csv
  /// Any of them, by its ending.
  std::filesystem::path any(const std::string& name) const;

  /// Where something new may be written meanwhile; the folder is there then.
  /// Errors: throws Error where it cannot be made.
  std::filesystem::path scratch();
  /// Puts a scratch file in its place. Errors: throws Error where it cannot be.
  void place(const std::filesystem::path& scratch, const std::filesystem::path& at) const;

  /// FILES. @param more_recordings  that lie elsewhere, by name
  nlohmann::ordered_json list(const std::vector<std::string>& more_recordings) const;

 private:
  // In a container that is started anew, so are process numbers: names go by the time too.
  static std::chrono::nanoseconds now() {
    return std::chrono::system_clock::now().time_since_epoch();
  }

  std::filesystem::path path_;
  std::atomic<std::uint64_t> scratch_files_;
};

}  // namespace vicinity::viewer
