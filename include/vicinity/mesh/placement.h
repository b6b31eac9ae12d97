// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// From a mesh file's own unit and frame into the workspace, in metres (§4.1.1).
#pragma once

#include <optional>
#include <string>
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

/// The three readings of a box whose unit is not stated, for a person to choose from:
/// "355 x 3.17 x 355 mm if the unit is mm; 355 x 3.17 x 355 m if m; 9.02 x 0.0805 x 9.02 m if
/// inches".
/// @param bounds  in the file's own unit; "nothing" for an empty box
std::string size_in_units(const Box& bounds);

/// Scales by `scale`, then moves by X_WO. Both act on coordinates in metres, so that a file's unit
/// is part of the scale: scale = s * metres_per(unit). Computed in double, vertex by vertex, so
/// that a mesh is turned as triangles and never as voxels.
/// Errors: throws Error for a scale that is not positive and finite; a mirrored mesh would be
/// inside out.
TriangleMesh place(TriangleMesh mesh, double scale, const Pose& X_WO);

}  // namespace vicinity
