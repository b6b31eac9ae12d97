// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A coloured section through a field, as in the paper's figures 13, 17 and 21.
#pragma once

#include <filesystem>
#include <optional>

#include "vicinity/geometry/vec3.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::cli {

/// A plane across one axis: the layer of voxels that holds `position`.
struct Slice {
  int axis = 2;             ///< 0, 1, 2: across x, y, z
  double position = 0;      ///< along that axis, in W [m]
  std::optional<Box> part;  ///< in W [m]; only the two axes in the plane matter; absent: all
};

/// Draws the section to a .png or .svg file: ranks coloured, boundary dark, inner hatched grey,
/// empty white; axes in metres; a legend with the viscosity of each rank; the objects' names. A
/// voxel is a whole number of pixels. Where the section has more voxels than a picture has room
/// for, one pixel stands for several voxels and shows the one nearest to a surface.
/// Errors: throws Error for a plane or a part outside the workspace, another extension, and where
/// the file cannot be written.
void draw_slice(const ViscosityField& field, const Slice& slice, const std::filesystem::path& path);

}  // namespace vicinity::cli
