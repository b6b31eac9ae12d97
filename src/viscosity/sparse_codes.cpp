// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/sparse_codes.h"

#include <algorithm>
#include <array>

namespace vicinity {

void SparseCodes::codes_at(std::span<const VoxelIndex> voxels, VoxelCode* codes) const noexcept {
  // Enough lookups at once to keep every line that a core can wait for on its way.
  constexpr std::size_t group = 64;
  static constexpr std::uint32_t empty = FieldReference::uniform(0);
  std::array<const std::uint32_t*, group> entries;
  std::array<std::uint32_t, group> references;
  std::array<std::uint8_t, group> mixed;  // which of the group lie in a brick of several codes
  while (!voxels.empty()) {
    const std::size_t count = std::min(group, voxels.size());
    // No step branches on what it finds: a wrong guess would throw away the loads behind it. What
    // the root settles is read once more, from where it was.
    for (std::size_t n = 0; n < count; ++n) {
      const VoxelIndex& v = voxels[n];
      const std::uint32_t* const above = holds(v) ? root_ + region_of(v) : &empty;
      const bool settled = FieldReference::is_uniform(*above);
      entries[n] = (settled ? above : regions_) + (settled ? 0 : entry_of(*above, v));
      __builtin_prefetch(entries[n]);
    }
    std::size_t mixed_count = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t reference = *entries[n];
      references[n] = reference;
      codes[n] = static_cast<VoxelCode>(reference);  // right where it is uniform
      mixed[mixed_count] = static_cast<std::uint8_t>(n);
      mixed_count += FieldReference::is_uniform(reference) ? 0 : 1;
    }
    for (std::size_t m = 0; m < mixed_count; ++m) {
      const std::size_t n = mixed[m];
      const std::byte* const brick = brick_of(references[n]);
      const unsigned width = references[n] >> FieldReference::width_shift;
      __builtin_prefetch(brick + ((voxel_in_brick(voxels[n]) << width) >> 3));
      __builtin_prefetch(brick + (std::size_t{64} << width));
    }
    for (std::size_t m = 0; m < mixed_count; ++m) {
      const std::size_t n = mixed[m];
      codes[n] =
          code_in_brick(brick_of(references[n]), references[n] >> FieldReference::width_shift,
                        voxel_in_brick(voxels[n]));
    }
    voxels = voxels.subspan(count);
    codes += count;
  }
}

}  // namespace vicinity
