// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/voxel.h"

namespace vicinity {

const char* to_string(VoxelKind kind) noexcept {
  switch (kind) {
    case VoxelKind::empty:
      return "empty";
    case VoxelKind::neighbour:
      return "neighbour";
    case VoxelKind::inner:
      return "inner";
    case VoxelKind::boundary:
      return "boundary";
  }
  return "unknown";
}

}  // namespace vicinity
