// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A brick of 8 x 8 x 8 voxels, dilated by at most R voxels, fills a cube of 8 + 2 R. Its rows along
// x are numbers of 16 bits (R = 4) or 32 bits (R = 8), and the 8 + 2 R rows of a layer lie side by
// side in vector registers: dilation along x is shifts within the numbers, along y unaligned loads,
// along z another layer. Only full cubes are ever written, so that no case at an edge is left.

#include "brick_stamp.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "vicinity/geometry/widest_vectors.h"

namespace vicinity {
namespace {

template <int Reach>
struct Layers {
  static constexpr int side = 8 + 2 * Reach;
  using Row = std::conditional_t<Reach <= 4, std::uint16_t, std::uint32_t>;
  static constexpr int lanes = Reach <= 4 ? 16 : 8;  // of one vector
  static constexpr int vectors = side / lanes;
  using Vector [[gnu::vector_size(32)]] = Row;
  using Bytes [[gnu::vector_size(lanes)]] = std::uint8_t;
};

template <int Reach>
[[gnu::always_inline]] inline void stamp_brick(const BrickBits& source,
                                               const ElementProfiles& element, BrickStamp& stamp) {
  using L = Layers<Reach>;
  using Row = typename L::Row;
  using Vector = typename L::Vector;
  constexpr int side = L::side;
  const int m = element.radius;
  const std::size_t profile_count = element.profiles.size();

  // Layers of the cube, from Reach below the brick to Reach above it.
  std::array<std::array<Vector, L::vectors>, side> cube{};
  // Rows of one source layer dilated along x by each reach, zeros before and behind.
  std::array<std::array<Row, side + 2 * Reach>, Reach + 1> dilated{};
  for (std::size_t k = 0; k < 8; ++k) {
    const std::uint64_t word = source.words[k];
    if (word == 0) continue;
    for (std::size_t j = 0; j < 8; ++j) {
      const auto row = static_cast<Row>(((word >> (8 * j)) & 0xff) << Reach);
      dilated[0][2 * Reach + j] = row;
      Row longer = row;
      for (int reach = 1; reach <= m; ++reach) {
        longer = static_cast<Row>(longer | row << reach | row >> reach);
        dilated[static_cast<std::size_t>(reach)][2 * Reach + j] = longer;
      }
    }
    std::array<std::array<Vector, L::vectors>, Reach + 1> sums;  // a profile for each |dk|
    for (std::size_t p = 0; p < profile_count; ++p) {
      std::array<Vector, L::vectors> sum{};
      for (int dj = -m; dj <= m; ++dj) {
        const std::int32_t reach = element.profiles[p][static_cast<std::size_t>(dj + m)];
        if (reach < 0) continue;
        const Row* const rows =
            &dilated[static_cast<std::size_t>(reach)][static_cast<std::size_t>(Reach - dj)];
        for (std::size_t v = 0; v < sum.size(); ++v) {
          Vector row;
          std::memcpy(&row, rows + v * static_cast<std::size_t>(L::lanes), sizeof(row));
          sum[v] |= row;
        }
      }
      sums[p] = sum;
    }
    for (int dk = -m; dk <= m; ++dk) {
      const auto& sum = sums[element.of_layer[static_cast<std::size_t>(dk + m)]];
      auto& target = cube[k + static_cast<std::size_t>(Reach + dk)];
      for (std::size_t v = 0; v < sum.size(); ++v) target[v] |= sum[v];
    }
  }

  // Cut the cube into bricks: bytes of eight voxels, in a frame of 24 x 24 rows.
  constexpr std::size_t margin = 8 - Reach;
  for (std::size_t layer = 0; layer < side; ++layer) {
    for (std::size_t v = 0; v < L::vectors; ++v) {
      const Vector rows = cube[layer][v];
      const std::array<Vector, 3> cut = {rows << (8 - Reach), rows >> Reach, rows >> (8 + Reach)};
      for (std::size_t di = 0; di < 3; ++di) {
        const auto bytes = __builtin_convertvector(cut[di] & Row{0xff}, typename L::Bytes);
        auto* const frame = reinterpret_cast<std::uint8_t*>(stamp.rows[di][margin + layer].data());
        std::memcpy(frame + margin + v * static_cast<std::size_t>(L::lanes), &bytes, sizeof(bytes));
      }
    }
  }
  stamp.reached_bricks = 0;
  for (std::size_t di = 0; di < 3; ++di) {
    for (std::size_t dk = 0; dk < 3; ++dk) {
      std::array<std::uint64_t, 3> any{};
      for (std::size_t k = 0; k < 8; ++k) {
        for (std::size_t dj = 0; dj < 3; ++dj) any[dj] |= stamp.rows[di][dk * 8 + k][dj];
      }
      for (std::size_t dj = 0; dj < 3; ++dj) {
        stamp.reached_bricks |= std::uint32_t{any[dj] != 0} << (dk * 9 + dj * 3 + di);
      }
    }
  }
}

}  // namespace

ElementProfiles::ElementProfiles(const ShapingElement& element) : radius(element.radius()) {
  for (int dk = -radius; dk <= radius; ++dk) {
    Profile profile;
    profile.fill(-1);
    for (const ShapingElement::Row& row : element.rows()) {
      if (row.k == dk) profile[static_cast<std::size_t>(row.j + radius)] = row.reach;
    }
    const auto known = std::find(profiles.begin(), profiles.end(), profile);
    of_layer[static_cast<std::size_t>(dk + radius)] =
        static_cast<std::uint8_t>(known - profiles.begin());
    if (known == profiles.end()) profiles.push_back(profile);
  }
}

VICINITY_WIDEST_VECTORS
void stamp_near(const BrickBits& source, const ElementProfiles& element, BrickStamp& stamp) {
  stamp_brick<4>(source, element, stamp);
}

VICINITY_WIDEST_VECTORS
void stamp_far(const BrickBits& source, const ElementProfiles& element, BrickStamp& stamp) {
  stamp_brick<8>(source, element, stamp);
}

}  // namespace vicinity
