// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Runs the program that was built, as a shell would, in a folder of its own.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vicinity::cli_test {

struct Answer {
  int code = -1;  ///< exit code, or 128 + signal
  std::string out, err;

  nlohmann::ordered_json json() const { return nlohmann::ordered_json::parse(out); }
};

/// A folder that goes with the test.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// Writes a text file and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const;
  /// Names of the files in it, sorted.
  std::vector<std::string> files() const;

  /// Runs `vicinity arguments...` with this folder as working directory.
  Answer run(const std::vector<std::string>& arguments,
             const std::string& standard_input = "") const;
  /// Starts it and returns at once; what it says is lost.
  pid_t start(const std::vector<std::string>& arguments) const;

 private:
  std::filesystem::path path_;
};

/// Exit code of a process that was started, or 128 + signal.
int wait_for(pid_t process);

std::string text_of(const std::filesystem::path& path);

/// A box of 0.2 x 0.1 x 0.1 m and a sphere beside it, voxels of 10 mm, m 2, q 3: built in no time.
extern const char* const small_scene;

}  // namespace vicinity::cli_test
