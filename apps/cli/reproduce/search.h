// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What nearest-surface search costs and where it fails, beside the lookup: figures 4 and 6 to 8.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reproduce/item.h"
#include "reproduce/nearest_surface.h"

namespace vicinity::report {

/// The vicinity reaches this far from a surface, in voxels: what six layers of m = 4 cover in every
/// direction.
inline constexpr double vicinity_vox = 16;

/// Points of a part's vicinity: centres of voxels outside it.
struct ShadedCorners {
  std::string part;
  std::uint64_t points = 0;
  std::uint64_t shaded = 0;  ///< no triangle's inner normal projection exists
  std::uint64_t wrong = 0;   ///< one exists, but another surface is nearer by half a voxel or more
  std::uint64_t unlabelled = 0;  ///< our lookup finds no viscosity
  int zones = 0;                 ///< shaded stretches on a closed way around the part
};

/// Fig. 8. @param parts  the pentagonal, the curved and the complex cylinder
std::vector<Check> check_fig8(const std::vector<ShadedCorners>& parts);
Outcome fig8(Workshop& workshop);

/// Cost of one query on one mesh.
struct QueryCost {
  std::uint64_t triangles = 0;
  double looked_at_by_tree = 0;  ///< triangles per query, mean; the sequential scan's is all
  double sequential_ns = 0, tree_ns = 0, lookup_ns = 0;
  double tree_error_vox = 0;     ///< largest difference to the distance of all triangles
  double spared_by_box = 0;      ///< share of queries that a box around the vicinity excludes
  std::uint64_t unlabelled = 0;  ///< queries for which the lookup found no viscosity
};

/// Fig. 6 and 7. @param costs  by growing number of triangles
std::vector<Check> check_fig7(const std::vector<QueryCost>& costs);
Outcome fig7(Workshop& workshop);

}  // namespace vicinity::report
