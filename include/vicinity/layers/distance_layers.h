// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Ranks from the exact Euclidean distance to the surface, with the distance kept (eq. 3).
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "vicinity/layers/ranked_neighbours.h"
#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/block_grid.h"

namespace vicinity {

/// Distances of 64 x 8 x 8 voxels, 8 KiB, in the order of BitBlock: value of voxel (i,j,k) at
/// ((k & 7) * 8 + (j & 7)) * 64 + (i & 63).
struct DistanceBlock {
  std::array<std::uint16_t, 4096> steps{};
};

/// One step of a stored distance, in voxels. 2^-7: 16 bits hold the farthest layer, 32 * 8 voxels.
inline constexpr double distance_step_vox = 1.0 / 128;

/// Half the diagonal of a voxel, in voxels: no point of a voxel is farther from its centre.
inline constexpr double half_diagonal_vox = 0.8660254037844387;

/// The layers of one object, and how far each of their voxels is from its surface.
struct DistanceLayers {
  RankedNeighbours neighbours;
  /// Distance from voxel centre to the nearest triangle, rounded down to distance_step_vox, for
  /// every boundary voxel and every ranked neighbour.
  BlockGrid<DistanceBlock> distances;
};

/// Exact Euclidean distance from voxel centres to the surface, by the regions in which each face,
/// edge and vertex can be nearest.
///
/// With D the distance from the centre of an empty voxel, in voxels, every point of the voxel is at
/// least s = max(0, D - half_diagonal_vox) away, and its rank is floor(s / m) + 1: rank n says "at
/// least (n-1)*m voxels away" and is never optimistic. Voxels with s >= q*m take no rank.
///
/// Distances are right to 1e-6 voxels before they are rounded; triangles lower than 2e-6 voxels
/// count as their edges. Neither the order of triangles nor the number of threads changes the
/// result. The boxes reach one voxel beyond q*m: D is measured from the centre.
///
/// @param mesh  the object, placed in W [m]
/// @param m     voxels per rank, 1..8
/// @param q     number of ranks, 0..32
/// Errors: throws Error for m or q out of range.
DistanceLayers distance_layers(const TriangleMesh& mesh, const VoxelSet& boundary,
                               const VoxelSet& inner, const Workspace& workspace, int m, int q);

/// The same for a part of the voxels at a time: what the surface's faces, edges and vertices have
/// to do with each slab of eight layers is found once.
class SurfaceDistances {
 public:
  /// @param mesh  the object, placed in W [m]; not needed afterwards
  /// @param m, q  as above
  /// Errors: throws Error for m or q out of range.
  SurfaceDistances(const TriangleMesh& mesh, const Workspace& workspace, int m, int q);
  SurfaceDistances(SurfaceDistances&&) noexcept;
  SurfaceDistances& operator=(SurfaceDistances&&) noexcept;
  ~SurfaceDistances();

  /// The box of all layers of the object whose boundary lies in `boundary`.
  VoxelBox box(const VoxelBox& boundary) const;

  /// The layers' voxels within a box; only there need boundary and inner be known. Slabs are worked
  /// on side by side: a box of few slabs keeps few threads busy.
  DistanceLayers layers(const VoxelSet& boundary, const VoxelSet& inner,
                        const VoxelBox& within) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace vicinity
