// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity serve: the viewer, in a browser.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "replay/arm.h"

namespace vicinity::viewer {

struct ServeOptions {
  std::filesystem::path input;  ///< field, or scene (.yaml, .yml)
  cli::ArmOptions arm;          ///< `scene`: its robot, and the meshes of its objects
  std::string start;            ///< joints at the start: "q,q,..." [rad or m]; empty: zero, or the
                                ///< middle of limits that leave zero out
  std::string bind = "127.0.0.1";
  int port = 8080;
  std::string token;
  std::filesystem::path folder = "vicinity-viewer";  ///< of uploads, saved scenes and fields
  std::vector<std::filesystem::path> recordings;     ///< each is there
  std::filesystem::path shot;                        ///< .png: draw the page there, and end
  std::string shot_view;          ///< added to the address of the page that is drawn
  std::optional<double> seconds;  ///< end by itself
};

/// Serves until Ctrl-C, or as the options say.
/// @return 0
/// Errors: throws Error for a field, scene, robot or address that cannot be used, for recordings
/// that are not there, a folder that is none, joints beyond their limits and words that the page
/// does not know, and where --shot has no browser or no page.
int serve(const ServeOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::viewer
