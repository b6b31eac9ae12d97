// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Ranks and distances of one slab of blocks, from the features that can be nearest there.
///
/// The features that can be nearest to a voxel of a box are those whose regions touch the box. So
/// boxes are cut into eight, and only what touches a part is handed on to it:
///
///     slab -> tiles of 64 x 64 x 8 -> blocks of 64 x 8 x 8 -> bricks of 8 x 8 x 8 -> cells of 4 x
///     4 x 4
///
/// In a cell, a dozen features are left of a smooth surface, whatever its triangles' number, and
/// each of them is asked by all 64 voxels at once. That is in single precision with a known error;
/// the one voxel in a hundred whose rounded distance or rank hangs on that error asks again in
/// double precision. Which features are asked therefore shows in the time, not in the result.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "region_lanes.h"
#include "surface_features.h"
#include "vicinity/layers/distance_layers.h"

namespace vicinity {

/// Memory to fill one slab after another; each thread has its own.
class SlabDistances {
 public:
  /// Works within the box of `layers`.
  SlabDistances(const SurfaceFeatures& features, const VoxelSet& boundary, const VoxelSet& inner,
                int m, int q, DistanceLayers& layers);

  /// @param slab    number of the slab: layers k with k >> 3 == slab
  /// @param listed  all features whose regions touch it; more do no harm
  void fill(std::int32_t slab, std::span<const std::uint32_t> listed);

 private:
  void sort_into_tiles(std::span<const std::uint32_t> listed);
  void fill_tile(std::int32_t tile_i, std::int32_t tile_j, std::span<const std::uint32_t> listed);
  void fill_block(std::span<const std::uint32_t> listed);
  void fill_brick(std::int32_t first_i, std::span<const std::uint32_t> listed);
  void fill_cell(const VoxelIndex& first, std::span<const std::uint32_t> listed);
  bool find_wanted();
  void measure_again(const VoxelIndex& voxel, std::span<const std::uint32_t> listed,
                     std::uint16_t& steps, std::uint8_t& rank) const;
  void store();

  const SurfaceFeatures& features_;
  const VoxelSet &boundary_, &inner_;
  const int m_, q_;
  DistanceLayers& layers_;
  const VoxelBox box_;
  const Rounding rounding_;

  std::int32_t slab_ = 0;
  std::span<const std::uint32_t> ids_;  ///< the slab's features
  HugeVector<NearestRegion> regions_;   ///< of the same; lists below are positions here
  std::int32_t first_tile_j_ = 0, tiles_j_ = 0;
  std::vector<std::vector<std::uint32_t>> of_tile_;
  EightLists of_block_, of_brick_, of_cell_;

  // The block at hand.
  BlockIndex block_;
  std::array<std::uint64_t, 64> wanted_{};  ///< voxels that may take a rank, and the skin
  std::array<std::uint64_t, 4>
      any_wanted_{};  ///< of the 4 x 4 rows of cells: (k, j) = 0 0, 0 1, ..
  std::array<std::uint16_t, 4096> steps_{};
  std::array<std::uint8_t, 4096> ranks_{};  ///< less one; q: none
};

}  // namespace vicinity
