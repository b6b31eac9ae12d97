// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a shaping element reaches from the voxels of one brick.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "vicinity/layers/layer_bricks.h"
#include "vicinity/layers/shaping_element.h"

namespace vicinity {

/// The element as profiles: what one layer of source rows gives to the layer dk above or below.
/// Layers with equal profiles (all of a cube, dk and -dk of a sphere) share one.
struct ElementProfiles {
  explicit ElementProfiles(const ShapingElement& element);

  /// Where what reaches row j + dj begins, among the rows of a layer that were dilated along x: one
  /// for each dj.
  using Profile = std::vector<std::uint32_t>;

  int radius;
  std::vector<Profile> profiles;
  std::array<std::uint8_t, 17> of_layer{};  // [dk + radius] -> profile
};

/// A brick dilated: the voxels reached in it and in the 26 bricks around it.
struct BrickStamp {
  static constexpr unsigned bricks_around = 27;

  static constexpr unsigned index_of(int di, int dj, int dk) noexcept {
    return static_cast<unsigned>((di + 1) * 9 + (dj + 1) * 3 + dk + 1);
  }

  /// Bit index_of(di, dj, dk): whether any voxel of that brick is reached.
  std::uint32_t reached_bricks = 0;
  /// [(di + 1) * 3 + dj + 1][(dk + 1) * 8 + layer]: eight rows of eight voxels.
  using Column = std::array<std::uint64_t, 24>;
  alignas(64) std::array<Column, 9> columns{};

  BrickBits at(unsigned brick) const noexcept {
    BrickBits bits;
    std::memcpy(bits.words.data(), &columns[brick / 3][brick % 3 * 8], sizeof(bits.words));
    return bits;
  }
};

/// Dilates a brick. A stamp may be used again and again, with one element.
void dilate(const BrickBits& source, const ElementProfiles& element, BrickStamp& stamp);

}  // namespace vicinity
