// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Which triangles of a mesh pass near a box of voxels.
#pragma once

#include <cstdint>
#include <vector>

#include "slabbed_mesh.h"
#include "vicinity/voxel/block_grid.h"

namespace vicinity {

/// The triangles by the cubes of 128 voxels that they pass through.
class TriangleBins {
 public:
  explicit TriangleBins(const SlabbedMesh& mesh);

  /// Triangles whose bounding box meets the box, in rising order; some others may be among them
  /// only where they pass through the same bins.
  std::vector<std::uint32_t> near(const VoxelBox& box) const;

 private:
  template <class Visit>
  void for_each_bin(std::uint32_t triangle, Visit&& visit) const;

  const SlabbedMesh& mesh_;
  VoxelIndex lo_, size_;             // of the grid of bins
  std::vector<std::size_t> starts_;  // of each bin in listed_, and the end
  std::vector<std::uint32_t> listed_;
};

}  // namespace vicinity
