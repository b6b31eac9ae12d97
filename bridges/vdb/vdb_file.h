// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A field as sparse volumes for Blender and Houdini.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "vicinity/viscosity/voxel_quantity.h"

namespace vicinity {

/// What a file holds where nothing else is asked for.
inline const std::vector<VoxelQuantity> usual_vdb_quantities = {VoxelQuantity::rank,
                                                                VoxelQuantity::viscosity};

/// Writes one OpenVDB float grid per quantity, named as the quantity; empty voxels are left out.
/// Floats for whole numbers too, because common readers know no integer grids.
/// @param progress  called with the share that is done, 0..1
/// Errors: throws Error where the file cannot be written; then it is not left half done.
void write_vdb(const ViscosityField& field, const VoxelBox& box,
               const std::vector<VoxelQuantity>& quantities, const std::filesystem::path& path,
               const std::function<void(double)>& progress);

}  // namespace vicinity
