// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A field as an image for ParaView.
#pragma once

#include <filesystem>
#include <functional>

#include "vicinity/viscosity/voxel_quantity.h"

namespace vicinity {

/// Writes VTK XML ImageData with one cell per voxel, its values appended raw.
/// @param progress  called with the share that is done, 0..1
/// Errors: throws Error where the file cannot be written; then it is not left half done.
void write_vti(const ViscosityField& field, const VoxelBox& box, VoxelQuantity quantity,
               const std::filesystem::path& path, const std::function<void(double)>& progress);

}  // namespace vicinity
