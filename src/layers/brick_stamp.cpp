// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A brick of 8 x 8 x 8 voxels, dilated by at most R voxels, fills a cube of 8 + 2 R. Its rows along
// x are numbers of 16 bits (R = 4) or 32 bits (R = 8), and the 8 + 2 R rows of a layer lie side by
// side in vector registers: dilation along x is shifts within the numbers, along y unaligned loads,
// along z another layer. Only full cubes are ever written, so that no case at an edge is left. Each
// step is done for all layers before the next one begins: a vector that is loaded right after parts
// of it were stored waits for them.

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
  // Rows dilated along x by one reach, with zeros before and behind.
  static constexpr int stride = side + 2 * Reach;
  // The eight rows of a source layer.
  using Source [[gnu::vector_size(8 * sizeof(Row))]] = Row;
  using SourceBytes [[gnu::vector_size(8)]] = std::uint8_t;
};

// 8 + 2 R rows of eight voxels, from row -R on, as a layer of three bricks along y.
template <int Reach>
[[gnu::always_inline]] inline std::array<std::uint64_t, 3> split_rows(
    const typename Layers<Reach>::Bytes* rows) {
  if constexpr (Reach <= 4) {
    std::array<std::uint64_t, 2> half;
    std::memcpy(half.data(), rows, sizeof(half));
    return {half[0] << 32, half[0] >> 32 | half[1] << 32, half[1] >> 32};
  } else {
    std::array<std::uint64_t, 3> whole;
    std::memcpy(whole.data(), rows, sizeof(whole));
    return whole;
  }
}

template <int Reach>
[[gnu::always_inline]] inline void stamp_brick(const BrickBits& source,
                                               const ElementProfiles& element, BrickStamp& stamp) {
  using L = Layers<Reach>;
  using Vector = typename L::Vector;
  using Layer = std::array<Vector, L::vectors>;
  constexpr std::size_t side = L::side;
  const int m = element.radius;

  // Along x: the rows of each source layer dilated by each reach.
  using Row = typename L::Row;
  std::array<std::array<Row, L::stride*(Reach + 1)>, 8> dilated;
  std::size_t first = 8, last = 0;  // layers that hold anything
  for (std::size_t k = 0; k < 8; ++k) {
    if (source.words[k] == 0) continue;
    first = std::min(first, k);
    last = k;
    typename L::SourceBytes bytes;
    std::memcpy(&bytes, &source.words[k], sizeof(bytes));
    const auto rows = __builtin_convertvector(bytes, typename L::Source) << Reach;
    auto longer = rows;
    for (std::size_t reach = 0; reach <= static_cast<std::size_t>(m); ++reach) {
      longer |= rows << static_cast<Row>(reach) | rows >> static_cast<Row>(reach);
      Row* const target = &dilated[k][L::stride * reach];
      std::memset(target, 0, L::stride * sizeof(Row));
      std::memcpy(target + 2 * Reach, &longer, sizeof(longer));
    }
  }

  // Along y: each source layer by each profile.
  std::array<std::array<Layer, Reach + 1>, 8> sums;
  for (std::size_t k = first; k <= last; ++k) {
    for (std::size_t p = 0; p < element.profiles.size(); ++p) {
      Layer sum{};
      if (source.words[k] != 0) {
        for (const std::uint32_t begin : element.profiles[p]) {
          const Row* const rows = &dilated[k][begin];
          for (std::size_t v = 0; v < sum.size(); ++v) {
            Vector part;
            std::memcpy(&part, rows + v * static_cast<std::size_t>(L::lanes), sizeof(part));
            sum[v] |= part;
          }
        }
      }
      sums[k][p] = sum;
    }
  }

  // Along z, from Reach below the brick to Reach above it, and cut into bricks.
  constexpr std::size_t margin = 8 - Reach;
  using Bytes = typename L::Bytes;
  std::array<std::array<std::array<Bytes, L::vectors>, 3>, 3> any{};  // [di][dk]
  for (std::size_t layer = 0; layer < side; ++layer) {
    const int k = static_cast<int>(layer) - Reach;
    Layer rows{};
    const int from = std::max(k - m, static_cast<int>(first));
    const int to = std::min(k + m, static_cast<int>(last));
    for (int at = from; at <= to; ++at) {
      const auto& sum = sums[static_cast<std::size_t>(at)]
                            [element.of_layer[static_cast<std::size_t>(k - at + m)]];
      for (std::size_t v = 0; v < rows.size(); ++v) rows[v] |= sum[v];
    }
    constexpr std::array<int, 3> shifts = {Reach - 8, Reach, Reach + 8};  // to the right
    for (std::size_t di = 0; di < 3; ++di) {
      std::array<Bytes, L::vectors> bytes;
      for (std::size_t v = 0; v < rows.size(); ++v) {
        const int shift = shifts[di];
        const Vector cut = shift < 0 ? rows[v] << -shift : rows[v] >> shift;
        bytes[v] = __builtin_convertvector(cut & Row{0xff}, Bytes);
        any[di][(margin + layer) / 8][v] |= bytes[v];
      }
      const std::array<std::uint64_t, 3> words = split_rows<Reach>(bytes.data());
      for (std::size_t dj = 0; dj < 3; ++dj) {
        stamp.columns[di * 3 + dj][margin + layer] = words[dj];
      }
    }
  }
  stamp.reached_bricks = 0;
  for (std::size_t di = 0; di < 3; ++di) {
    for (std::size_t dk = 0; dk < 3; ++dk) {
      const std::array<std::uint64_t, 3> words = split_rows<Reach>(any[di][dk].data());
      for (std::size_t dj = 0; dj < 3; ++dj) {
        stamp.reached_bricks |= std::uint32_t{words[dj] != 0} << (di * 9 + dj * 3 + dk);
      }
    }
  }
}

// Reach 4 where that is enough, else 8.
bool is_near(int radius) noexcept { return radius <= 4; }

template <int Reach>
std::uint32_t begin_of(const ShapingElement::Row& row) noexcept {
  return static_cast<std::uint32_t>(Layers<Reach>::stride * row.reach + Reach - row.j);
}

VICINITY_WIDEST_VECTORS
void dilate_near(const BrickBits& source, const ElementProfiles& element, BrickStamp& stamp) {
  stamp_brick<4>(source, element, stamp);
}

VICINITY_WIDEST_VECTORS
void dilate_far(const BrickBits& source, const ElementProfiles& element, BrickStamp& stamp) {
  stamp_brick<8>(source, element, stamp);
}

}  // namespace

ElementProfiles::ElementProfiles(const ShapingElement& element) : radius(element.radius()) {
  for (int dk = -radius; dk <= radius; ++dk) {
    Profile profile;
    for (const ShapingElement::Row& row : element.rows()) {
      if (row.k == dk) profile.push_back(is_near(radius) ? begin_of<4>(row) : begin_of<8>(row));
    }
    const auto known = std::find(profiles.begin(), profiles.end(), profile);
    of_layer[static_cast<std::size_t>(dk + radius)] =
        static_cast<std::uint8_t>(known - profiles.begin());
    if (known == profiles.end()) profiles.push_back(profile);
  }
}

void dilate(const BrickBits& source, const ElementProfiles& element, BrickStamp& stamp) {
  is_near(element.radius) ? dilate_near(source, element, stamp)
                          : dilate_far(source, element, stamp);
}

}  // namespace vicinity
