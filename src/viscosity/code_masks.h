// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A brick as the set of voxels of each of its codes: 512 voxels are compared in eight words.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vicinity/layers/layer_bricks.h"
#include "vicinity/viscosity/field_image.h"

namespace vicinity {

/// Distinct codes in rising order, each with its voxels; none is empty, and together they are all.
class CodeMasks {
 public:
  /// More codes than that are rare enough to be looked at voxel by voxel.
  static constexpr std::size_t most = 64;

  std::size_t count() const noexcept { return count_; }
  std::span<const VoxelCode> codes() const noexcept { return std::span(codes_).first(count_); }
  const BrickBits& mask(std::size_t n) const noexcept { return masks_[n]; }

  void clear() noexcept { count_ = 0; }
  /// Adds a code that is higher than all before.
  void push(VoxelCode code, const BrickBits& mask) noexcept {
    assert(count_ < most);
    codes_[count_] = code;
    masks_[count_++] = mask;
  }
  /// Puts codes that were pushed in any order in rising order.
  void sort() noexcept;
  /// Renames every code; their order stays.
  template <class Map>
  void rename(Map&& map) noexcept {
    for (std::size_t n = 0; n < count_; ++n) codes_[n] = map(codes_[n]);
  }

 private:
  std::size_t count_ = 0;
  std::array<VoxelCode, most> codes_;
  std::array<BrickBits, most> masks_;
};

/// Voxels in a mask.
std::uint32_t count(const BrickBits& mask) noexcept;

/// The codes of a brick given as planes: plane b holds bit b of every voxel's code, at most 6.
void split(std::span<const BrickBits> planes, CodeMasks& masks) noexcept;

/// The codes of a brick as it lies in an image.
/// @return  false, and nothing in `masks`, where there are too many
bool split(std::uint32_t reference, const std::byte* brick, CodeMasks& masks) noexcept;

}  // namespace vicinity
