// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/bridge.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "vicinity/geometry/error.h"

namespace vicinity::cli {

void become_bridge(char** arguments) {
  std::string name = "vicinity-bridge";
  std::vector<char*> words = {name.data()};
  while (*arguments != nullptr) words.push_back(*arguments++);
  words.push_back(nullptr);

  std::error_code unknown;
  const auto here = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
  if (!unknown) execv((here / name).c_str(), words.data());
  if (unknown || errno == ENOENT) execvp(name.c_str(), words.data());
  if (errno == ENOENT) {
    throw Error(
        {.where = "vicinity bridge",
         .what =
             "is a program of its own, " + name + ", which is neither beside this one nor on PATH",
         .hint = "installing the package " + name + ", or building with -DVICINITY_BRIDGE=ON"});
  }
  throw Error({.where = name, .what = std::string("cannot be run: ") + std::strerror(errno)});
}

}  // namespace vicinity::cli
