// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Blocks of 64 x 8 x 8 voxels to their eight bricks, and back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vicinity/layers/layer_bricks.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity {

/// Turns a matrix of 8 x 8 bytes over its diagonal: halves, quarters, single bytes.
inline void transpose_bytes(std::array<std::uint64_t, 8>& w) noexcept {
  const auto swap = [&](std::size_t a, std::size_t b, int shift, std::uint64_t low) {
    const std::uint64_t t = ((w[a] >> shift) ^ w[b]) & low;
    w[b] ^= t;
    w[a] ^= t << shift;
  };
  for (std::size_t j = 0; j < 4; ++j) swap(j, j + 4, 32, 0x00000000ffffffff);
  for (const std::size_t j : {0, 1, 4, 5}) swap(j, j + 2, 16, 0x0000ffff0000ffff);
  for (const std::size_t j : {0, 2, 4, 6}) swap(j, j + 1, 8, 0x00ff00ff00ff00ff);
}

/// The eight bricks of a block: its rows are cut into bytes, and bytes of eight rows make a word of
/// a brick.
inline std::array<BrickBits, 8> bricks_of(const BitBlock& block) noexcept {
  std::array<BrickBits, 8> bricks;
  for (std::size_t k = 0; k < 8; ++k) {
    std::array<std::uint64_t, 8> rows;
    for (std::size_t j = 0; j < 8; ++j) rows[j] = block.words[k * 8 + j];
    transpose_bytes(rows);
    for (std::size_t b = 0; b < 8; ++b) bricks[b].words[k] = rows[b];
  }
  return bricks;
}

/// Adds eight bricks to their block.
inline void add_bricks(const std::array<BrickBits, 8>& bricks, BitBlock& block) noexcept {
  for (std::size_t k = 0; k < 8; ++k) {
    std::array<std::uint64_t, 8> words;
    for (std::size_t b = 0; b < 8; ++b) words[b] = bricks[b].words[k];
    transpose_bytes(words);
    for (std::size_t j = 0; j < 8; ++j) block.words[k * 8 + j] |= words[j];
  }
}

}  // namespace vicinity
