// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// An exact Euclidean distance transform of a whole dense array: what ranks cost the plain way.
///
/// Debian has no fast one for three dimensions (scipy has one of a single thread), so
/// this stands in for the fastest open one; docs/performance.md says how the two compare.
#pragma once

#include <cstdint>
#include <vector>

#include "vicinity/voxel/workspace.h"

namespace vicinity::peers {

/// Distance of every voxel's centre from the nearest one that is set, in voxels, by lower envelopes
/// of parabolas along y and z (Felzenszwalb & Huttenlocher 2012). In parallel over planes.
/// @param set  x fastest, shape dims
/// @return     the same shape; infinite where none is set
std::vector<float> exact_transform(const std::vector<std::uint8_t>& set, const VoxelIndex& dims);

}  // namespace vicinity::peers
