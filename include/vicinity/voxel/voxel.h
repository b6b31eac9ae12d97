// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a voxel is (fig. 10).
#pragma once

#include <cstdint>

namespace vicinity {

/// Kinds of voxel. A higher kind wins where objects overlap.
enum class VoxelKind : std::uint8_t {
  empty = 0,      ///< free space
  neighbour = 1,  ///< in a ranked layer around an object
  inner = 2,      ///< inside an object
  boundary = 3,   ///< a triangle passes through it
};

/// "empty", "neighbour", "inner" or "boundary".
const char* to_string(VoxelKind kind) noexcept;

}  // namespace vicinity
