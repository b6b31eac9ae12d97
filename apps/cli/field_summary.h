// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What is in a field, as people and as programs want it said.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "vicinity/viscosity/field.h"

namespace vicinity::cli {

/// Voxels of the finished field, by kind and by rank.
struct VoxelCounts {
  std::uint64_t boundary = 0, inner = 0, neighbour = 0;
  std::vector<std::uint64_t> ranks;  ///< ranks[n-1]: neighbours of rank n, over all objects
};

/// Looks at every voxel, on all cores.
VoxelCounts count_voxels(const ViscosityField& field);

/// One row per object: triangles, closed, voxels, layers, bound.
std::string objects_table(const ViscosityField& field);

/// "520 x 400 x 340 voxels of 5 mm, from (0, 0, 0) to (2.6, 2, 1.7) m".
std::string grid_in_words(const Workspace& workspace);

/// The largest bound over all objects [mm]: how much nearer than its rank says a point can be.
double largest_bound_mm(const ViscosityField& field);

/// Keys `voxel_size`, `origin`, `dims` of the documented JSON.
void add_grid(nlohmann::ordered_json& json, const Workspace& workspace);

}  // namespace vicinity::cli
