// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The loops of the distance layers over eight boxes or 64 voxels at a time.
///
/// Written as loops over lanes that any compiler turns into vectors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "nearest_region.h"

namespace vicinity {

/// Eight boxes of voxel centres, all of one size, in grid coordinates.
struct EightBoxes {
  alignas(32) float x[8] = {}, y[8] = {}, z[8] = {};  ///< middles
  float half_x, half_y, half_z;        ///< sizes
};

/// For each of eight boxes, which regions touch it.
class EightLists {
 public:
  /// Of the regions listed, those that touch; in the order of the list.
  void fill(std::span<const NearestRegion> regions, std::span<const std::uint32_t> listed,
            const EightBoxes& boxes);

  std::span<const std::uint32_t> operator[](std::size_t box) const noexcept {
    return {&of_box_[box * stride_], count_[box]};
  }

 private:
  std::vector<std::uint32_t> of_box_;
  std::size_t stride_ = 0;
  std::array<std::size_t, 8> count_{};
};

/// A cell is 4 x 4 x 4 voxels, in the order of k, j, i.
inline constexpr std::size_t cell_voxels = 64;

/// How far the voxels of a cell are from the nearest of the features listed, in single precision.
struct CellDistances {
  alignas(64) float squared[cell_voxels];  ///< infinite where no region holds the voxel
  float error;                             ///< of positions, see NearestRegion
};

void measure_cell(std::span<const NearestRegion> regions, std::span<const std::uint32_t> listed,
                  float middle_x, float middle_y, float middle_z, CellDistances& distances);

/// How distances are stored.
struct Rounding {
  float steps_per_voxel;
  float first_rank;      ///< where rank 1 ends less `m`: half the diagonal of a voxel
  float ranks_per_voxel; ///< 1 / m
  float farthest;        ///< beyond it, there is no rank; above q * m + first_rank
};

struct RoundedCell {
  alignas(64) std::uint16_t steps[cell_voxels];
  alignas(64) std::uint8_t ranks[cell_voxels];  ///< less one, or q and more: none
  std::uint64_t unsure;                         ///< voxels for which single precision cannot tell
};

void round_cell(const CellDistances& distances, const Rounding& rounding, RoundedCell& rounded);

}  // namespace vicinity
