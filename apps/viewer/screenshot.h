// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A picture of a page, by a real browser without a window.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

namespace vicinity::viewer {

/// The browser on PATH, or nothing.
std::optional<std::filesystem::path> find_browser();

/// Opens the address, waits until the page says that it is drawn, and writes a PNG beside `path`
/// and renamed into place. The browser runs in a child process with a profile of its own, and ends
/// with it.
/// @param err  hears what the page's console said
/// Errors: throws Error where there is no browser, it cannot be spoken to, or the page is not drawn
/// within a minute.
void take_screenshot(const std::string& address, const std::filesystem::path& path,
                     std::ostream& err);

}  // namespace vicinity::viewer
