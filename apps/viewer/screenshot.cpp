// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "screenshot.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <thread>

#include "browser.h"
#include "fresh_file.h"
#include "vicinity/geometry/error.h"

namespace vicinity::viewer {
namespace {

constexpr int width = 1600, height = 1000;
// Drawn by a processor that others share, the first picture may take a minute; what takes much
// longer has hung.
constexpr auto longest_wait = std::chrono::minutes(5);

int letter_value(char c) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t at = letters.find(c);
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

std::string from_base64(std::string_view text) {
  std::string bytes;
  unsigned held = 0;
  int bits = 0;
  for (const char c : text) {
    const int value = letter_value(c);
    if (value < 0) break;
    held = held << 6 | static_cast<unsigned>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 0xFF);
  }
  return bytes;
}

}  // namespace

std::optional<std::filesystem::path> find_browser() {
  const char* const path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');) {
      const std::filesystem::path program = std::filesystem::path(folder) / name;
      if (::access(program.c_str(), X_OK) == 0) return program;
    }
  }
  return {};
}

void take_screenshot(const std::string& address, const std::filesystem::path& path,
                     std::ostream& err) {
  const auto program = find_browser();
  if (!program) {
    throw Error({.where = "--shot",
                 .what = "needs a browser to draw the page",
                 .found = "no chromium on PATH",
                 .hint = "apt-get install chromium"});
  }
  Browser browser(*program);
  browser.open(address, width, height);
  const auto until = std::chrono::steady_clock::now() + longest_wait;
  bool drawn = false;
  while (!drawn && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    drawn = browser.evaluate("document.documentElement.dataset.ready") == "true";
  }
  for (const std::string& line : browser.console()) err << "console " << line << '\n';
  if (!drawn) {
    throw Error({.where = "--shot",
                 .what = "the page was not drawn within five minutes",
                 .found = browser.evaluate("document.body.innerText.slice(0, 200)").dump()});
  }
  const auto picture = browser.call("Page.captureScreenshot", {{"format", "png"}});
  cli::FreshFile file(path);
  file.write(from_base64(picture.at("data").get<std::string>()));
  file.commit();
}

}  // namespace vicinity::viewer
