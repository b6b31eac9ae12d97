// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Objects, each alone in its own array -> one field of the workspace.
#pragma once

#include <functional>
#include <vector>

#include "vicinity/layers/distance_layers.h"
#include "vicinity/viscosity/field.h"
#include "vicinity/voxel/voxel_set.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// One object in its own object voxel array, other objects absent.
struct ObjectVoxelArray {
  VoxelSet boundary, inner;
  DistanceLayers layers;  ///< without distances unless in `distance` mode
};

/// Maps objects back into the workspace, which cuts what lies beyond it. Where they overlap,
/// boundary beats inner beats neighbour, within one kind the higher viscosity wins, and ties go to
/// the object that comes first.
///
/// @param objects   in the order of their names
/// @param arrays    one for each object; they make room before the image is put together
/// @param progress  called with how much is done, 0..1, now and then, from one thread at a time
/// Errors: throws Error where the field outgrows its file format.
ViscosityField merge(const Workspace& workspace, const std::vector<FieldObject>& objects,
                     std::vector<ObjectVoxelArray> arrays,
                     const std::function<void(double done)>& progress);

}  // namespace vicinity
