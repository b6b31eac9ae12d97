// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The lookup: from a voxel through root, region and brick to its code, where they lie in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vicinity/viscosity/packed_brick.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// Index into the table of voxel records; 0 is empty space.
using VoxelCode = std::uint16_t;

/// A reference of 32 bits: either uniform, the value of every voxel below it, or the number of what
/// lies below it. The number of a brick of codes counts units of 8 bytes, and the log2 of its bits
/// per voxel (0..4) stands above it; packed codes of less than 16 bits index the table behind them.
struct FieldReference {
  static constexpr std::uint32_t uniform_bit = std::uint32_t{1} << 31;
  static constexpr int width_shift = 28;
  static constexpr std::uint32_t number_mask = (std::uint32_t{1} << width_shift) - 1;
  static constexpr std::size_t brick_unit = 8;  ///< [bytes]

  static constexpr std::uint32_t uniform(std::uint16_t value) noexcept {
    return uniform_bit | value;
  }
  static constexpr bool is_uniform(std::uint32_t reference) noexcept {
    return (reference & uniform_bit) != 0;
  }
};

/// Root, regions and bricks of an image that was verified: no lookup can leave it. It owns nothing.
/// The loads of a lookup, each of which needs the one before: root, region, brick, and the brick's
/// own table; what the code stands for is a fifth.
class SparseCodes {
 public:
  SparseCodes() = default;
  SparseCodes(const VoxelIndex& dims, const std::uint32_t* root, const std::uint32_t* regions,
              const std::byte* bricks) noexcept
      : dims_(dims), root_(root), regions_(regions), bricks_(bricks) {
    region_dim_i_ = static_cast<std::size_t>((dims.i + 63) >> 6);
    region_dim_j_ = static_cast<std::size_t>((dims.j + 63) >> 6);
  }

  bool holds(const VoxelIndex& v) const noexcept {
    return (static_cast<std::uint32_t>(v.i) < static_cast<std::uint32_t>(dims_.i)) &
           (static_cast<std::uint32_t>(v.j) < static_cast<std::uint32_t>(dims_.j)) &
           (static_cast<std::uint32_t>(v.k) < static_cast<std::uint32_t>(dims_.k));
  }

  /// The reference that settles a voxel that it holds: uniform, or to its brick.
  std::uint32_t reference(const VoxelIndex& v) const noexcept {
    const std::uint32_t above = root_[region_of(v)];
    return FieldReference::is_uniform(above) ? above : regions_[entry_of(above, v)];
  }

  VoxelCode code(std::uint32_t reference, const VoxelIndex& v) const noexcept {
    if (FieldReference::is_uniform(reference)) return static_cast<VoxelCode>(reference);
    return code_in_brick(brick_of(reference), reference >> FieldReference::width_shift,
                         voxel_in_brick(v));
  }

  /// 0 for a voxel that it does not hold.
  VoxelCode code_at(const VoxelIndex& v) const noexcept {
    return holds(v) ? code(reference(v), v) : VoxelCode{0};
  }

  /// Whether the brick of a voxel that it holds may have a voxel of a wanted code: goes by the
  /// brick's table, which may list a code that no voxel has, and never leaves one out.
  bool brick_may_hold(const VoxelIndex& v, std::span<const bool> wanted) const noexcept {
    const std::uint32_t above = reference(v);
    if (FieldReference::is_uniform(above)) return wanted[static_cast<VoxelCode>(above)];
    const std::byte* const brick = brick_of(above);
    const unsigned width = above >> FieldReference::width_shift;
    const bool has_table = width < 4;
    const std::byte* const codes = has_table ? brick + (std::size_t{64} << width) : brick;
    const std::size_t count = has_table ? table_size(brick, width) : 512;
    for (std::size_t n = 0; n < count; ++n) {
      if (wanted[load_16(codes + n * 2)]) return true;
    }
    return false;
  }

  /// code_at() of each. All lookups of a group take each step together, so that they wait for
  /// memory together: several times as fast as one by one where voxels lie far apart.
  void codes_at(std::span<const VoxelIndex> voxels, VoxelCode* codes) const noexcept;

 private:
  std::size_t region_of(const VoxelIndex& v) const noexcept {
    return (static_cast<std::size_t>(v.k >> 6) * region_dim_j_ +
            static_cast<std::size_t>(v.j >> 6)) *
               region_dim_i_ +
           static_cast<std::size_t>(v.i >> 6);
  }
  static std::size_t entry_of(std::uint32_t region, const VoxelIndex& v) noexcept {
    return std::size_t{region} * 512 +
           static_cast<std::size_t>(((v.k >> 3 & 7) * 8 + (v.j >> 3 & 7)) * 8 + (v.i >> 3 & 7));
  }
  const std::byte* brick_of(std::uint32_t reference) const noexcept {
    return bricks_ +
           std::size_t{reference & FieldReference::number_mask} * FieldReference::brick_unit;
  }

  VoxelIndex dims_;
  std::size_t region_dim_i_ = 0, region_dim_j_ = 0;
  const std::uint32_t* root_ = nullptr;
  const std::uint32_t* regions_ = nullptr;
  const std::byte* bricks_ = nullptr;
};

}  // namespace vicinity
