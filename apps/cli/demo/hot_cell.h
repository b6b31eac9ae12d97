// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The demo's files, carried inside the program.
#pragma once

#include <string_view>

#include "vicinity/geometry/vec3.h"

namespace vicinity::cli {

/// The text of scenes/hot_cell.yaml.
extern const std::string_view hot_cell_scene;

/// The text of scenes/hot_cell_arm.urdf.
extern const std::string_view hot_cell_arm_urdf;

/// Where the arm stands in the cell [m].
inline Pose hot_cell_arm_base() { return Pose(Eigen::Translation3d(0.95, 1.1, 0)); }

}  // namespace vicinity::cli
