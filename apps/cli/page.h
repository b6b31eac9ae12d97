// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// An index page: one file that needs nothing else, on a screen or on paper.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vicinity::cli {

struct PagePicture {
  std::filesystem::path file;  ///< .png or .svg; its bytes go into the page
  std::string title;
  std::string says;          ///< a sentence or two
  std::string command = {};  ///< that makes it again; may be empty
};

/// A paragraph with a heading beside it.
struct PageNote {
  std::string label, says;
  enum class Tone { plain, good, bad } tone = Tone::plain;
};

struct PageSection {
  std::string title;
  std::string says;
  std::vector<PageNote> notes = {};
  std::vector<PagePicture> pictures = {};
  bool two_to_a_row = false;                         ///< pictures
  std::vector<std::vector<std::string>> table = {};  ///< first row: headings; empty: no table
  std::vector<std::string> commands = {};            ///< to type, in order
  std::vector<std::string> links = {};               ///< files beside the page, relative to it
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
