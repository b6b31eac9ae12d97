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
  float half_x = 0, half_y = 0, half_z = 0;           ///< sizes
};

/// For each of eight boxes, which regions touch it.
class EightLists {
 public:
  /// @param listed  positions in `regions`; each list is a part of it, in its order
  void fill(std::span<const NearestRegion> regions, std::span<const std::uint32_t> listed,
            const EightBoxes& boxes);

  std::span<const std::uint32_t> operator[](std::size_t box) const noexcept {
    return {&of_boxes_[box * stride_], counts_[box]};
  }

 private:
  std::vector<std::uint32_t> of_boxes_;  ///< eight parts of stride_
  std::vector<std::uint8_t> touched_;    ///< by each region; the first box in bit 0
  std::size_t stride_ = 0;
  std::array<std::size_t, 8> counts_{};
};

/// A cell is 4 x 4 x 4 voxels, in the order of k, j, i.
inline constexpr std::size_t cell_voxels = 64;

/// How far the voxels of a cell are from the nearest of some features.
struct CellDistances {
  alignas(64) float squared[cell_voxels];  ///< infinite where no region holds the voxel
  float error;                             ///< the largest of their regions' errors
};

/// Measures the cell whose middle is given, in grid coordinates. All regions listed must touch it.
void measure_cell(std::span<const NearestRegion> regions, std::span<const std::uint32_t> listed,
                  float middle_x, float middle_y, float middle_z, CellDistances& distances);

/// How distances are rounded.
struct Rounding {
  float steps_per_voxel;
  float zero;  ///< the distance from which ranks are counted
  float ranks_per_voxel;
  float farthest;           ///< what is farther, or nowhere, counts as this far; beyond all ranks
  std::int32_t no_rank;     ///< this rank and higher ones are none
  std::int32_t most_steps;  ///< as many steps are stored at most
};

struct RoundedCell {
  std::uint16_t steps[cell_voxels];
  std::uint8_t ranks[cell_voxels];  ///< from 0; no_rank: none
  std::uint64_t unsure;             ///< voxels whose steps or rank hang on the distances' error
};

void round_cell(const CellDistances& distances, const Rounding& rounding, RoundedCell& rounded);

}  // namespace vicinity
