// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A brick of codes as it lies in the image: 512 packed codes, then the table they index.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// Position of a voxel in its brick.
inline std::size_t voxel_in_brick(const VoxelIndex& v) noexcept {
  return static_cast<std::size_t>(((v.k & 7) * 8 + (v.j & 7)) * 8 + (v.i & 7));
}

inline std::uint16_t load_16(const std::byte* from) noexcept {
  std::uint16_t value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

/// Index of a packed code in the table of its brick.
/// @param width  log2 of the bits of a code, 0..3
inline unsigned packed_code(const std::byte* brick, unsigned width, std::size_t voxel) noexcept {
  const std::size_t bit = voxel << width;
  const unsigned mask = (1u << (1u << width)) - 1;
  return std::to_integer<unsigned>(brick[bit >> 3]) >> (bit & 7) & mask;
}

/// Code of a voxel.
/// @param width  as above, or 4 for a brick without a table
inline std::uint16_t code_in_brick(const std::byte* brick, unsigned width,
                                   std::size_t voxel) noexcept {
  if (width == 4) return load_16(brick + voxel * 2);
  return load_16(brick + (std::size_t{64} << width) + packed_code(brick, width, voxel) * 2);
}

}  // namespace vicinity
