// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The page's files, inside the program.
#pragma once

#include <span>
#include <string_view>

namespace vicinity::viewer {

struct PageFile {
  std::string_view path;  ///< "/index.html"
  std::string_view bytes;
};

/// Empty where the page was not built. Made by CMake from what the page's build leaves.
std::span<const PageFile> page_files();

}  // namespace vicinity::viewer
