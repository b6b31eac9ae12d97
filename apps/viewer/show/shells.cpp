// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "show/shells.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <span>

namespace vicinity::viewer {
namespace {

constexpr std::int32_t chunk = 64;        // cells along each edge
constexpr std::int32_t side = chunk + 2;  // with a border of one cell
constexpr std::int32_t brick = 8;         // voxels that a field stores together
constexpr std::uint8_t empty_level = 255;
// Of the voxels of a layer, this share has a face outwards: flat layers have m voxels to a face,
// and a tilted face of one voxel shows up to three.
constexpr double faces_per_column = 1.5;

/// What a cell counts as: 0 skin, n rank n, empty_level beyond.
struct Cell {
  std::uint8_t level = empty_level;
  std::uint16_t object = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

Cell cell_of(const VoxelRecord& record) {
  switch (record.kind) {
    case VoxelKind::empty:
      return {};
    case VoxelKind::neighbour:
      return {record.rank, record.object};
    case VoxelKind::boundary:
    case VoxelKind::inner:
      break;
  }
  return {0, record.object};
}

/// The cells of one chunk and of its border.
class Cells {
 public:
  Cells(const ViscosityField& field, int step)
      : field_(field),
        step_(step),
        is_skin_(std::make_unique<bool[]>(field.records().size())),
        cells_(std::size_t{side} * side * side) {
    for (std::size_t code = 0; code < field.records().size(); ++code) {
      is_skin_[code] = cell_of(field.records()[code]).level == 0;
    }
  }

  /// @return whether the chunk itself holds anything
  bool fill(const VoxelIndex& first) {
    bool any = false;
    for (std::int32_t k = 0; k < side; ++k) {
      for (std::int32_t j = 0; j < side; ++j) {
        for (std::int32_t i = 0; i < side; ++i) {
          Cell& cell = at(i, j, k);
          cell = look({first.i + i - 1, first.j + j - 1, first.k + k - 1});
          any |= cell.level != empty_level;
        }
      }
    }
    return any;
  }

  Cell& at(std::int32_t i, std::int32_t j, std::int32_t k) {
    return cells_[(static_cast<std::size_t>(k) * side + static_cast<std::size_t>(j)) * side +
                  static_cast<std::size_t>(i)];
  }

 private:
  Cell look(const VoxelIndex& cell) const {
    const VoxelIndex lo{cell.i * step_, cell.j * step_, cell.k * step_};
    if (step_ == 1) return cell_of(field_.records()[field_.code_at(lo)]);
    // Bricks are aligned to multiples of eight, as cells are to multiples of their step, and the
    // array starts at zero. What a cell has beyond the array is empty, however large it is.
    const std::int32_t piece = std::min(step_, brick);
    const std::span wanted(is_skin_.get(), field_.records().size());
    const VoxelIndex dims = field_.workspace().dims;
    const VoxelIndex from{std::max(lo.i, 0), std::max(lo.j, 0), std::max(lo.k, 0)};
    const VoxelIndex to{std::min(lo.i + step_, dims.i), std::min(lo.j + step_, dims.j),
                        std::min(lo.k + step_, dims.k)};
    for (std::int32_t k = from.k; k < to.k; k += piece) {
      for (std::int32_t j = from.j; j < to.j; j += piece) {
        for (std::int32_t i = from.i; i < to.i; i += piece) {
          // Most bricks are layers: their tables tell that there is no skin to look for.
          if (!field_.brick_may_hold({i, j, k}, wanted)) continue;
          const Cell skin = skin_in({i, j, k}, piece);
          if (skin.level == 0) return skin;
        }
      }
    }
    const std::int32_t half = step_ / 2;
    return cell_of(field_.records()[field_.code_at({lo.i + half, lo.j + half, lo.k + half})]);
  }

  Cell skin_in(const VoxelIndex& lo, std::int32_t size) const {
    for (std::int32_t k = lo.k; k < lo.k + size; ++k) {
      for (std::int32_t j = lo.j; j < lo.j + size; ++j) {
        for (std::int32_t i = lo.i; i < lo.i + size; ++i) {
          const Cell cell = cell_of(field_.records()[field_.code_at({i, j, k})]);
          if (cell.level == 0) return cell;
        }
      }
    }
    return {};
  }

  const ViscosityField& field_;
  std::int32_t step_;
  std::unique_ptr<bool[]> is_skin_;  // by code
  std::vector<Cell> cells_;
};

/// Merges equal faces of one layer of a chunk into rectangles: as long as it goes, then as wide.
class Layer {
 public:
  Cell& at(std::int32_t a, std::int32_t b) {
    return faces_[static_cast<std::size_t>(b * chunk + a)];
  }

  template <class Emit>
  void merge(const Emit& emit) {
    for (std::int32_t b = 0; b < chunk; ++b) {
      for (std::int32_t a = 0; a < chunk; ++a) {
        const Cell face = at(a, b);
        if (face.level == empty_level) continue;
        std::int32_t along = 1, across = 1;
        while (a + along < chunk && at(a + along, b) == face) ++along;
        while (b + across < chunk && row_is(face, a, b + across, along)) ++across;
        for (std::int32_t y = b; y < b + across; ++y) {
          for (std::int32_t x = a; x < a + along; ++x) at(x, y) = {};
        }
        emit(face, a, b, along, across);
      }
    }
  }

 private:
  bool row_is(const Cell& face, std::int32_t a, std::int32_t b, std::int32_t along) {
    for (std::int32_t x = a; x < a + along; ++x) {
      if (at(x, b) != face) return false;
    }
    return true;
  }

  std::array<Cell, std::size_t{chunk} * chunk> faces_{};
};

using Ranks = std::vector<std::vector<Quad>>;

void add_quads(Cells& cells, const VoxelIndex& first, Layer& layer, Ranks& ranks) {
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, out = face % 2 == 1 ? 1 : -1;
    const int first_axis = axis == 0 ? 1 : 0, second_axis = axis == 2 ? 1 : 2;
    for (std::int32_t depth = 0; depth < chunk; ++depth) {
      bool any = false;
      for (std::int32_t b = 0; b < chunk; ++b) {
        for (std::int32_t a = 0; a < chunk; ++a) {
          std::array<std::int32_t, 3> at{};
          at[static_cast<std::size_t>(axis)] = depth + 1;
          at[static_cast<std::size_t>(first_axis)] = a + 1;
          at[static_cast<std::size_t>(second_axis)] = b + 1;
          const Cell here = cells.at(at[0], at[1], at[2]);
          if (here.level == empty_level) continue;
          at[static_cast<std::size_t>(axis)] += out;
          if (cells.at(at[0], at[1], at[2]).level <= here.level) continue;
          layer.at(a, b) = here;
          any = true;
        }
      }
      if (!any) continue;
      layer.merge([&](const Cell& shown, std::int32_t a, std::int32_t b, std::int32_t along,
                      std::int32_t across) {
        std::array<std::int32_t, 3> at{};
        at[static_cast<std::size_t>(axis)] = depth;
        at[static_cast<std::size_t>(first_axis)] = a;
        at[static_cast<std::size_t>(second_axis)] = b;
        Quad quad;
        quad.i = static_cast<std::uint16_t>(first.i + at[0]);
        quad.j = static_cast<std::uint16_t>(first.j + at[1]);
        quad.k = static_cast<std::uint16_t>(first.k + at[2]);
        quad.a = static_cast<std::uint16_t>(along);
        quad.b = static_cast<std::uint16_t>(across);
        quad.face = static_cast<std::uint8_t>(face);
        quad.object = shown.object;
        ranks[shown.level].push_back(quad);
      });
    }
  }
}

std::size_t most_ranks(const ViscosityField& field) {
  std::uint8_t highest = 0;
  for (const VoxelRecord& record : field.records()) highest = std::max(highest, record.rank);
  return highest;
}

}  // namespace

int step_for(const ViscosityField& field, double faces) {
  std::vector<double> by_rank(most_ranks(field) + 1, 0);
  for (const FieldObject& object : field.objects()) {
    by_rank[0] += static_cast<double>(object.boundary);
    for (std::size_t n = 0; n + 1 < by_rank.size() && n < object.ranks.size(); ++n) {
      by_rank[n + 1] += static_cast<double>(object.ranks[n]) / object.m;
    }
  }
  const double most = faces_per_column * *std::ranges::max_element(by_rank);
  int step = 1;
  while (most / step / step > faces && step < 1024) step *= 2;
  return step;
}

Shells shells_of(const ViscosityField& field, int step) {
  const VoxelIndex dims = field.workspace().dims;
  const std::int32_t longest = std::max({dims.i, dims.j, dims.k});
  Shells shells;
  shells.step = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(step, 1))));
  while (longest / shells.step > std::numeric_limits<std::uint16_t>::max()) shells.step *= 2;

  const auto chunks_along = [&](std::int32_t dim) {
    const std::int32_t cells = (dim + shells.step - 1) / shells.step;
    return static_cast<std::size_t>((cells + chunk - 1) / chunk);
  };
  const std::size_t ni = chunks_along(dims.i), nj = chunks_along(dims.j), nk = chunks_along(dims.k);
  const std::size_t levels = most_ranks(field) + 1;
  std::vector<Ranks> of_chunk(ni * nj * nk);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, of_chunk.size()), [&](const auto& range) {
    Cells cells(field, shells.step);
    Layer layer;
    for (std::size_t c = range.begin(); c < range.end(); ++c) {
      const VoxelIndex first{static_cast<std::int32_t>(c % ni) * chunk,
                             static_cast<std::int32_t>(c / ni % nj) * chunk,
                             static_cast<std::int32_t>(c / ni / nj) * chunk};
      if (!cells.fill(first)) continue;
      of_chunk[c].resize(levels);
      add_quads(cells, first, layer, of_chunk[c]);
    }
  });

  shells.by_rank.resize(levels);
  for (Ranks& ranks : of_chunk) {
    for (std::size_t n = 0; n < ranks.size(); ++n) {
      shells.by_rank[n].insert(shells.by_rank[n].end(), ranks[n].begin(), ranks[n].end());
    }
    ranks = {};
  }
  return shells;
}

}  // namespace vicinity::viewer
