// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The demo's index page: one file that needs nothing else, on a screen or on paper.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vicinity::cli {

struct PagePicture {
  std::filesystem::path file;  ///< .png; its bytes go into the page
  std::string title;
  std::string says;     ///< a sentence or two
  std::string command;  ///< that makes it again
};

struct PageSection {
  std::string title;
  std::string says;
  std::vector<PagePicture> pictures = {};
  std::vector<std::vector<std::string>> table = {};  ///< first row: headings; empty: no table
  std::vector<std::string> commands = {};            ///< to type, in order
};

struct Page {
  std::string title;
  std::string says;
  std::vector<PageSection> sections = {};
};

/// All text is plain: whatever HTML would read as its own is escaped.
/// Errors: throws Error where a picture cannot be read or the page not be written.
void write_page(const Page& page, const std::filesystem::path& path);

}  // namespace vicinity::cli
