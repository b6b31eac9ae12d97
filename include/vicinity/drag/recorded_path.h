// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a point records between two positions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vicinity/drag/viscosity_memory.h"
#include "vicinity/drag/voxel_walk.h"
#include "vicinity/viscosity/field.h"

namespace vicinity {

/// Which voxels a point records between two positions.
enum class Traversal {
  swept,    ///< every voxel on the straight path, so that a fast point cannot jump a thin layer
  sampled,  ///< the voxel it arrives in, as the paper does
};

/// The voxel that holds a point.
/// @param grid  in voxels from the workspace's origin, shape (3,); within 2^31 voxels of it
inline VoxelIndex voxel_of(const Vec3& grid) noexcept {
  return {static_cast<std::int32_t>(std::floor(grid.x())),
          static_cast<std::int32_t>(std::floor(grid.y())),
          static_cast<std::int32_t>(std::floor(grid.z()))};
}

/// In voxels from the workspace's origin. Positions beyond 2^30 are as far outside as can be.
inline Vec3 to_reachable_grid(const Workspace& workspace, const Vec3& p_W) noexcept {
  constexpr double farthest = 1 << 30;
  return workspace.to_grid(p_W).cwiseMax(-farthest).cwiseMin(farthest);
}

/// Cuts the path from a to b down to where it can matter: outside the workspace all is empty, and
/// whoever has passed memory_capacity empty voxels remembers nothing else. False where nothing is
/// left.
/// @param a,b  in voxels from the workspace's origin, shape (3,); finite
bool clip_to_reach(const VoxelIndex& dims, Vec3& a, Vec3& b) noexcept;

/// Enters each voxel on the straight path into a memory, and returns the highest mu_e on the way: a
/// layer that was passed between two ticks is felt in the second one, even with k = 1. At less than
/// a voxel a tick this is the mu_e of the paper.
///
/// @param from,to  in voxels from the workspace's origin, shape (3,); finite, within 2^31 voxels
/// @param mu       viscosity at `to` [N·s/m³]
/// @param voxel    in: the one that was recorded last; out: that of `to`
/// @param memory   has enter_voxel(mu), update(mu) and effective(weights), as ViscosityMemory
/// Real-time: time grows with the voxels on the path within reach of the workspace; no allocation.
template <class Memory>
double record_path(const ViscosityField& field, const MemoryWeights& weights, Vec3 from, Vec3 to,
                   double mu, VoxelIndex& voxel, Memory& memory) noexcept {
  const Workspace& workspace = field.workspace();
  if (!clip_to_reach(workspace.dims, from, to)) return memory.effective(weights);
  const VoxelIndex last = voxel_of(to);
  const bool continuous = field.keeps_distance();
  double highest = 0;
  walk_voxels(from, to, [&](const VoxelIndex& at, double enter, double leave) noexcept {
    if (at == voxel) {
      if (at != last) return;  // it was recorded when it was entered
      memory.update(mu);
    } else {
      double mu_here = mu;
      if (at != last) {
        const Vec3 middle = from + 0.5 * (enter + leave) * (to - from);
        mu_here = continuous ? field.at(workspace.origin + workspace.voxel_size * middle).viscosity
                             : field.viscosities()[field.code_at(at)];
      }
      memory.enter_voxel(mu_here);
      voxel = at;
    }
    highest = std::max(highest, memory.effective(weights));
  });
  return highest;
}

}  // namespace vicinity
