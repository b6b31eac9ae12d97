// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Fields that the tests move points through.
#pragma once

#include <functional>

#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field.h"

namespace vicinity {

/// A field of one object written voxel by voxel, without the build: voxels of 1 m from the origin,
/// rank 1 to 6 of the paper's coding.
/// @param record_of  what each voxel is; object 0
ViscosityField painted_field(const VoxelIndex& dims,
                             const std::function<VoxelRecord(const VoxelIndex&)>& record_of);

/// The field of one mesh, placed as it is, with layers as in the paper: m = 4, q = 6 unless given.
ViscosityField field_around(const TriangleMesh& mesh, LayerShape layers, double voxel_size,
                            int m = 4, int q = 6);

}  // namespace vicinity
