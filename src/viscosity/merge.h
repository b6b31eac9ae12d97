// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Objects, each alone in its own array -> one field of the workspace.
#pragma once

#include <functional>
#include <vector>

#include "object_voxel_array.h"
#include "vicinity/viscosity/field.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// A field, and what a later merge needs to keep most of it.
struct MergedField {
  ViscosityField field;
  std::vector<VoxelCounts> region_counts;  ///< of each distinct region
};

/// What a merge may take over from one before: every region of `merged` but those that are marked.
/// Same workspace, and same objects but for their arrays in marked regions.
struct EarlierMerge {
  const MergedField& merged;
  const std::vector<char>& changed;  ///< by region, in the order of the root
};

/// Maps objects back into the workspace, which cuts what lies beyond it. Where they overlap,
/// boundary beats inner beats neighbour, within one kind the higher viscosity wins, and ties go to
/// the object that comes first. The result does not depend on the number of threads, nor on what
/// was taken over.
///
/// @param objects   in the order of their names
/// @param arrays    one for each object
/// @param earlier   null where everything is to be merged
/// @param progress  called with how much is done, 0..1, now and then, from one thread at a time
/// Errors: throws Error where the field outgrows its file format.
MergedField merge(const Workspace& workspace, const std::vector<FieldObject>& objects,
                  const std::vector<const ObjectVoxelArray*>& arrays, const EarlierMerge* earlier,
                  const std::function<void(double done)>& progress);

}  // namespace vicinity
