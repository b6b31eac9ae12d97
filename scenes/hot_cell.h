// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The demo's files, carried inside the program.
#pragma once

#include <string_view>

namespace vicinity {

/// The text of scenes/hot_cell.yaml.
extern const std::string_view hot_cell_scene;

/// The text of scenes/hot_cell_arm.urdf.
extern const std::string_view hot_cell_arm_urdf;

/// The text of scenes/hot_cell_tasks.yaml.
extern const std::string_view hot_cell_tasks;

}  // namespace vicinity
