// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "code_masks.h"

#include <bit>
#include <cstring>

#include "vicinity/geometry/widest_vectors.h"
#include "vicinity/viscosity/packed_brick.h"

namespace vicinity {
namespace {

/// Moves bit 2 n of a word to bit n, or bit 4 n.
constexpr std::uint64_t gather_2(std::uint64_t w) noexcept {
  w &= 0x5555555555555555;
  w = (w | w >> 1) & 0x3333333333333333;
  w = (w | w >> 2) & 0x0f0f0f0f0f0f0f0f;
  w = (w | w >> 4) & 0x00ff00ff00ff00ff;
  w = (w | w >> 8) & 0x0000ffff0000ffff;
  return (w | w >> 16) & 0xffffffff;
}
constexpr std::uint64_t gather_4(std::uint64_t w) noexcept {
  w &= 0x1111111111111111;
  w = (w | w >> 3) & 0x0303030303030303;
  w = (w | w >> 6) & 0x000f000f000f000f;
  w = (w | w >> 12) & 0x000000ff000000ff;
  return (w | w >> 24) & 0xffff;
}

/// Planes of the indices of a brick, from 1, 2 or 4 bits a voxel (width 0, 1 or 2).
VICINITY_WIDEST_VECTORS
void unpack(const std::byte* brick, unsigned width, std::array<BrickBits, 4>& planes) noexcept {
  std::array<std::uint64_t, 32> words;
  std::memcpy(words.data(), brick, std::size_t{64} << width);
  for (std::size_t k = 0; k < 8; ++k) {
    if (width == 0) planes[0].words[k] = words[k];
    if (width == 1) {
      for (std::size_t b = 0; b < 2; ++b) {
        planes[b].words[k] = gather_2(words[2 * k] >> b) | gather_2(words[2 * k + 1] >> b) << 32;
      }
    }
    if (width == 2) {
      for (std::size_t b = 0; b < 4; ++b) {
        planes[b].words[k] = gather_4(words[4 * k] >> b) | gather_4(words[4 * k + 1] >> b) << 16 |
                             gather_4(words[4 * k + 2] >> b) << 32 |
                             gather_4(words[4 * k + 3] >> b) << 48;
      }
    }
  }
}

/// Splits a brick by one plane after another, highest first, and keeps what is not empty.
VICINITY_WIDEST_VECTORS
void split_by_planes(const BrickBits* planes, std::size_t plane_count, CodeMasks& found) noexcept {
  BrickBits all;
  all.words.fill(~std::uint64_t{0});
  found.clear();
  found.push(0, all);
  for (std::size_t p = plane_count; p-- > 0;) {
    CodeMasks halves;
    for (std::size_t n = 0; n < found.count(); ++n) {
      BrickBits zeros, ones;
      std::uint64_t any_zero = 0, any_one = 0;
      for (std::size_t k = 0; k < 8; ++k) {
        const std::uint64_t word = found.mask(n).words[k], plane = planes[p].words[k];
        any_zero |= zeros.words[k] = word & ~plane;
        any_one |= ones.words[k] = word & plane;
      }
      const auto code = static_cast<VoxelCode>(found.codes()[n] * 2);
      if (any_zero != 0) halves.push(code, zeros);
      if (any_one != 0) halves.push(static_cast<VoxelCode>(code + 1), ones);
    }
    found.clear();
    for (std::size_t n = 0; n < halves.count(); ++n) found.push(halves.codes()[n], halves.mask(n));
  }
}

}  // namespace

void CodeMasks::sort() noexcept {
  for (std::size_t n = 1; n < count_; ++n) {
    for (std::size_t at = n; at > 0 && codes_[at] < codes_[at - 1]; --at) {
      std::swap(codes_[at], codes_[at - 1]);
      std::swap(masks_[at], masks_[at - 1]);
    }
  }
}

std::uint32_t count(const BrickBits& mask) noexcept {
  int voxels = 0;
  for (const std::uint64_t word : mask.words) voxels += std::popcount(word);
  return static_cast<std::uint32_t>(voxels);
}

void split(std::span<const BrickBits> planes, CodeMasks& masks) noexcept {
  split_by_planes(planes.data(), planes.size(), masks);
}

bool split(std::uint32_t reference, const std::byte* brick, CodeMasks& masks) noexcept {
  masks.clear();
  if (FieldReference::is_uniform(reference)) {
    BrickBits all;
    all.words.fill(~std::uint64_t{0});
    masks.push(static_cast<VoxelCode>(reference), all);
    return true;
  }
  const unsigned width = reference >> FieldReference::width_shift;
  if (width > 2) return false;
  std::array<BrickBits, 4> planes;
  unpack(brick, width, planes);
  split_by_planes(planes.data(), std::size_t{1} << width, masks);
  masks.rename(
      [&](VoxelCode index) { return load_16(brick + (std::size_t{64} << width) + 2 * index); });
  return true;
}

}  // namespace vicinity
