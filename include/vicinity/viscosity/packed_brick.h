// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A brick of codes as it lies in the image: 512 packed codes, then the table they index.
#pragma once

#include <algorithm>
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

/// Highest index among the packed codes of a brick.
/// @param width  log2 of the bits of a code, 0..3
inline unsigned highest_packed_code(const std::byte* brick, unsigned width) noexcept {
  constexpr std::uint64_t evens = 0x5555555555555555;
  std::uint64_t ones = 0, twos = 0, threes = 0;
  unsigned highest = 0;
  switch (width) {
    case 0:
    case 1:
      for (std::size_t n = 0; n < std::size_t{8} << width; ++n) {
        std::uint64_t word;
        std::memcpy(&word, brick + n * 8, sizeof(word));
        ones |= word & evens;
        twos |= word & ~evens;
        threes |= word & (word >> 1) & evens;
      }
      if (width == 0) return (ones | twos) != 0 ? 1 : 0;
      return threes != 0 ? 3 : twos != 0 ? 2 : ones != 0 ? 1 : 0;
    case 2:
      for (std::size_t n = 0; n < 256; ++n) {
        const auto pair = std::to_integer<unsigned>(brick[n]);
        highest = std::max({highest, pair & 15, pair >> 4});
      }
      return highest;
    default:
      for (std::size_t n = 0; n < 512; ++n)
        highest = std::max(highest, std::to_integer<unsigned>(brick[n]));
      return highest;
  }
}

/// Number of entries in the table of a brick.
/// @param width  as above, or 4 for a brick without a table
inline std::size_t table_size(const std::byte* brick, unsigned width) noexcept {
  return width == 4 ? 0 : std::size_t{highest_packed_code(brick, width)} + 1;
}

/// Bytes that a brick with so many entries in its table takes: whole units of `unit` bytes.
inline std::size_t brick_size(unsigned width, std::size_t entries, std::size_t unit) noexcept {
  return ((std::size_t{64} << width) + entries * 2 + unit - 1) / unit * unit;
}

}  // namespace vicinity
