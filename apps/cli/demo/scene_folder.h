// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The demo's scene as files that a person can copy and edit.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vicinity/viscosity/scene.h"

namespace vicinity::cli {

/// Writes each primitive of a scene as an STL file in millimetres, FOLDER/meshes/NAME.stl, and the
/// scene as FOLDER/scene.yaml, where `mesh:` and `units: mm` stand in place of `primitive:`. All
/// else stays as it was written, comments and poses too.
/// @param text  a scene that has each `- name:` and each `primitive:` on a line of its own
/// @return      the STL files, in the order of the scene
/// Errors: throws Error where the folder cannot be written, and as parse_scene().
std::vector<std::filesystem::path> write_scene_folder(std::string_view text,
                                                      const std::filesystem::path& folder);

}  // namespace vicinity::cli
