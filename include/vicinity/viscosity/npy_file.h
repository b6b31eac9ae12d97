// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A field as an array for numpy.
#pragma once

#include <filesystem>
#include <functional>

#include "vicinity/viscosity/voxel_quantity.h"

namespace vicinity {

/// Writes an array of shape (nx, ny, nz) in C order, and beside it a .json of the same name with
/// origin [m], voxel size [m], dims and what the values are; both replace what was there, as
/// save_field() does.
/// @param progress  called with the share that is done, 0..1
/// Errors: throws Error where a file cannot be written; then neither is left half done.
void write_npy(const ViscosityField& field, const VoxelBox& box, VoxelQuantity quantity,
               const std::filesystem::path& path, const std::function<void(double)>& progress);

}  // namespace vicinity
