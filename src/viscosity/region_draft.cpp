// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A brick's codes are packed as indices into its own table, which lists them in rising order: equal
// bricks are equal bytes, however they came to be.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "code_masks.h"
#include "sparse_layer.h"
#include "vicinity/geometry/widest_vectors.h"
#include "vicinity/viscosity/field_image.h"
#include "vicinity/viscosity/packed_brick.h"

namespace vicinity {
namespace {

/// Whether all values of a brick are the same: each equals the one behind it.
bool is_uniform(std::span<const std::uint16_t, 512> values) noexcept {
  return std::memcmp(values.data(), values.data() + 1, values.size_bytes() - 2) == 0;
}

/// log2 of the bits that index a table of so many codes.
unsigned width_for(std::size_t distinct) noexcept {
  return distinct <= 2    ? 0
         : distinct <= 4  ? 1
         : distinct <= 16 ? 2
         : distinct < 256 ? 3   // at 256, the table is as long as the codes
                          : 4;  // 16 bits: the codes themselves
}

/// A packed brick, with room for the largest that has a table.
struct PackedBrick {
  alignas(8) std::array<std::byte, 512 + 2 * 256 + FieldReference::brick_unit> bytes;
  std::size_t size = 0;

  /// Writes the table behind the packed codes, and zeros up to a whole unit.
  void put_table(unsigned width, std::span<const VoxelCode> table) noexcept {
    const std::size_t packed = std::size_t{64} << width;
    size = brick_size(width, table.size(), FieldReference::brick_unit);
    std::memcpy(bytes.data() + packed, table.data(), table.size_bytes());
    std::memset(bytes.data() + packed + table.size_bytes(), 0, size - packed - table.size_bytes());
  }
};

/// Moves bit n of the low half of a word to bit 2 n, or of its low quarter to bit 4 n.
constexpr std::uint64_t spread_2(std::uint64_t w) noexcept {
  w &= 0xffffffff;
  w = (w | w << 16) & 0x0000ffff0000ffff;
  w = (w | w << 8) & 0x00ff00ff00ff00ff;
  w = (w | w << 4) & 0x0f0f0f0f0f0f0f0f;
  w = (w | w << 2) & 0x3333333333333333;
  return (w | w << 1) & 0x5555555555555555;
}
constexpr std::uint64_t spread_4(std::uint64_t w) noexcept {
  w &= 0xffff;
  w = (w | w << 24) & 0x000000ff000000ff;
  w = (w | w << 12) & 0x000f000f000f000f;
  w = (w | w << 6) & 0x0303030303030303;
  return (w | w << 3) & 0x1111111111111111;
}

/// Packs the masks of 2 to 64 codes.
/// @return  the width
VICINITY_WIDEST_VECTORS
unsigned pack(const CodeMasks& found, PackedBrick& brick) noexcept {
  const unsigned width = width_for(found.count());
  std::array<BrickBits, 6> planes{};  // bit b of every voxel's index
  for (std::size_t n = 1; n < found.count(); ++n) {
    for (std::size_t b = 0; b < 6; ++b) {
      if ((n >> b & 1) == 0) continue;
      for (std::size_t k = 0; k < 8; ++k) planes[b].words[k] |= found.mask(n).words[k];
    }
  }
  std::array<std::uint64_t, 64> words{};
  for (std::size_t k = 0; k < 8; ++k) {
    if (width == 0) words[k] = planes[0].words[k];
    if (width == 1) {
      for (std::size_t half = 0; half < 2; ++half) {
        const std::size_t shift = half * 32;
        words[k * 2 + half] =
            spread_2(planes[0].words[k] >> shift) | spread_2(planes[1].words[k] >> shift) << 1;
      }
    }
    if (width == 2) {
      for (std::size_t quarter = 0; quarter < 4; ++quarter) {
        for (std::size_t b = 0; b < 4; ++b)
          words[k * 4 + quarter] |= spread_4(planes[b].words[k] >> quarter * 16) << b;
      }
    }
    if (width == 3) {
      for (std::size_t v = 0; v < 64; ++v) {
        for (std::size_t b = 0; b < 6; ++b)
          words[k * 8 + v / 8] |= (planes[b].words[k] >> v & 1) << (v % 8 * 8 + b);
      }
    }
  }
  std::memcpy(brick.bytes.data(), words.data(), std::size_t{64} << width);
  brick.put_table(width, found.codes());
  return width;
}

}  // namespace

bool RegionDraft::Layer::is_uniform() const noexcept {
  return FieldReference::is_uniform(references[0]) &&
         std::all_of(references.begin(), references.end(),
                     [this](std::uint32_t r) { return r == references[0]; });
}

RegionDraft::RegionDraft() {
  codes_.references.fill(FieldReference::uniform(0));
  distances_.references.fill(FieldReference::uniform(no_distance));
}

void RegionDraft::put_uniform(std::size_t brick, VoxelCode code) {
  codes_.references[brick] = FieldReference::uniform(code);
}

void RegionDraft::put_packed(std::size_t brick, unsigned width, std::span<const std::byte> packed) {
  codes_.references[brick] =
      width << FieldReference::width_shift |
      static_cast<std::uint32_t>(codes_.bytes.size() / FieldReference::brick_unit);
  codes_.hashes[brick] = short_hash(packed);
  codes_.bytes.insert(codes_.bytes.end(), packed.begin(), packed.end());
}

void RegionDraft::put_masks(std::size_t brick, const CodeMasks& masks) {
  if (masks.count() == 1) return put_uniform(brick, masks.codes()[0]);
  PackedBrick packed;
  const unsigned width = pack(masks, packed);
  put_packed(brick, width, std::span(packed.bytes).first(packed.size));
}

void RegionDraft::put_codes(std::size_t brick, std::span<const VoxelCode, 512> codes) {
  if (is_uniform(codes)) return put_uniform(brick, codes[0]);
  std::array<VoxelCode, 512> table;  // distinct codes, at first in order of appearance
  std::array<std::uint16_t, 512> indices;
  std::size_t distinct = 0;
  std::size_t latest = 0;  // neighbours along x mostly hold the same code
  for (std::size_t v = 0; v < 512; ++v) {
    if (distinct == 0 || table[latest] != codes[v]) {
      latest = static_cast<std::size_t>(
          std::find(table.begin(), table.begin() + distinct, codes[v]) - table.begin());
      if (latest == distinct) table[distinct++] = codes[v];
    }
    indices[v] = static_cast<std::uint16_t>(latest);
  }
  const unsigned width = width_for(distinct);
  if (width == 4) return put_packed(brick, width, std::as_bytes(codes));

  std::array<VoxelCode, 512> sorted = table;
  std::sort(sorted.begin(), sorted.begin() + distinct);
  std::array<std::uint8_t, 256> place;  // in `sorted`, of each in `table`
  for (std::size_t n = 0; n < distinct; ++n) {
    place[n] = static_cast<std::uint8_t>(
        std::lower_bound(sorted.begin(), sorted.begin() + distinct, table[n]) - sorted.begin());
  }
  PackedBrick packed;
  const std::size_t bits = std::size_t{1} << width;
  const std::size_t per_byte = 8 / bits;
  for (std::size_t v = 0; v < 512; v += per_byte) {
    unsigned byte = 0;
    for (std::size_t n = 0; n < per_byte; ++n)
      byte |= unsigned{place[indices[v + n]]} << (n * bits);
    packed.bytes[v / per_byte] = static_cast<std::byte>(byte);
  }
  packed.put_table(width, std::span(sorted).first(distinct));
  put_packed(brick, width, std::span(packed.bytes).first(packed.size));
}

void RegionDraft::put_distances(std::size_t brick, std::span<const std::uint16_t, 512> steps) {
  if (is_uniform(steps)) {
    distances_.references[brick] = FieldReference::uniform(steps[0]);
    return;
  }
  const std::span<const std::byte> bytes = std::as_bytes(steps);
  distances_.references[brick] =
      static_cast<std::uint32_t>(distances_.bytes.size() / FieldReference::brick_unit);
  distances_.hashes[brick] = short_hash(bytes);
  distances_.bytes.insert(distances_.bytes.end(), bytes.begin(), bytes.end());
}

}  // namespace vicinity
