// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// From a mesh file's own unit and frame into the workspace, in metres (§4.1.1).
#pragma once

#include <optional>
#include <string_view>

#include "vicinity/geometry/vec3.h"
#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

/// What one unit of a mesh file means.
enum class LengthUnit { millimetre, centimetre, metre, inch };

/// Metres per unit.
double metres_per(LengthUnit unit) noexcept;

/// "mm", "cm", "m" or "in" -> unit; "inch" and "inches" too. Nothing for another word.
std::optional<LengthUnit> length_unit(std::string_view word) noexcept;

/// Scales by `scale`, then moves by X_WO. Both act on coordinates in metres, so that a file's unit
/// is part of the scale: scale = s * metres_per(unit). Computed in double, vertex by vertex, so
/// that a mesh is turned as triangles and never as voxels.
TriangleMesh place(TriangleMesh mesh, double scale, const Pose& X_WO);

}  // namespace vicinity
