// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a shaping element reaches from the voxels of one brick.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vicinity/layers/layer_bricks.h"
#include "vicinity/layers/shaping_element.h"

namespace vicinity {

/// The element as profiles: what one layer of source rows gives to the layer dk above or below.
/// Layers with equal profiles (all of a cube, dk and -dk of a sphere) share one.
struct ElementProfiles {
  explicit ElementProfiles(const ShapingElement& element);

  using Profile = std::array<std::int32_t, 17>;  // [dj + radius] -> reach, -1: no row
  int radius;
  std::vector<Profile> profiles;
  std::array<std::uint8_t, 17> of_layer{};  // [dk + radius] -> profile
};

/// A brick dilated: the voxels reached in it and in the 26 bricks around it.
struct BrickStamp {
  /// Bit (dk + 1) * 9 + (dj + 1) * 3 + di + 1: whether any voxel of that brick is reached.
  std::uint32_t reached_bricks = 0;

  BrickBits at(unsigned brick) const noexcept {
    const unsigned di = brick % 3, dj = brick / 3 % 3, dk = brick / 9;
    BrickBits bits;
    for (std::size_t k = 0; k < 8; ++k) bits.words[k] = rows[di][dk * 8 + k][dj];
    return bits;
  }

  /// [di + 1][(dk + 1) * 8 + layer][dj + 1]: eight rows of eight voxels.
  alignas(64) std::array<std::array<std::array<std::uint64_t, 3>, 24>, 3> rows{};
};

/// Dilates a brick. A stamp may be used again and again, with elements of radius up to 4 in one,
/// of any radius in another.
void stamp_near(const BrickBits& source, const ElementProfiles& element, BrickStamp& stamp);
void stamp_far(const BrickBits& source, const ElementProfiles& element, BrickStamp& stamp);

}  // namespace vicinity
