// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/clearance_map.h"

#include <algorithm>
#include <cmath>

namespace vicinity {
namespace {

constexpr std::int64_t most_cells = 1 << 22;

// Farther is as good as this: a ball that large holds any link of an arm.
constexpr std::uint8_t farthest_cells = 32;

// One axis of the chessboard distance to the occupied cells, in place: d(x) becomes the least of
// max(|x - s|, d(s)) over all s. A cube is the product of three segments, so that one pass for each
// axis gives the distance exactly.
void spread_along(std::vector<std::uint8_t>& distance, std::size_t count, std::size_t stride,
                  std::size_t start, std::vector<int>& line) {
  for (std::size_t x = 0; x < count; ++x) line[x] = distance[start + x * stride];
  for (std::size_t x = 0; x < count; ++x) {
    int best = line[x];
    for (int r = 1; r < best; ++r) {
      const auto reach = static_cast<std::size_t>(r);
      if (x >= reach) best = std::min(best, std::max(r, line[x - reach]));
      if (x + reach < count) best = std::min(best, std::max(r, line[x + reach]));
    }
    distance[start + x * stride] = static_cast<std::uint8_t>(best);
  }
}

}  // namespace

ClearanceMap::ClearanceMap(const ViscosityField& field) {
  const VoxelIndex voxels = field.workspace().dims;
  size_ = Vec3(voxels.i, voxels.j, voxels.k);
  const auto cells_along = [&](std::int32_t n) { return (n + cell_ - 1) / cell_; };
  const auto cell_count = [&] {
    return std::int64_t{cells_along(voxels.i)} * cells_along(voxels.j) * cells_along(voxels.k);
  };
  while (cell_count() > most_cells) cell_ *= 2;
  dims_ = {cells_along(voxels.i), cells_along(voxels.j), cells_along(voxels.k)};
  const auto at = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(dims_.j) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(dims_.i) +
           static_cast<std::size_t>(i);
  };
  cells_between_.assign(static_cast<std::size_t>(cell_count()), farthest_cells);
  const std::int32_t bricks = cell_ / 8;
  const auto bricks_along = [](std::int32_t n) { return (n + 7) / 8; };
  for (std::int32_t k = 0; k < bricks_along(voxels.k); ++k) {
    for (std::int32_t j = 0; j < bricks_along(voxels.j); ++j) {
      for (std::int32_t i = 0; i < bricks_along(voxels.i); ++i) {
        if (!field.brick_is_empty({i * 8, j * 8, k * 8})) {
          cells_between_[at(i / bricks, j / bricks, k / bricks)] = 0;
        }
      }
    }
  }
  std::vector<int> line(static_cast<std::size_t>(std::max({dims_.i, dims_.j, dims_.k})));
  const auto ni = static_cast<std::size_t>(dims_.i), nj = static_cast<std::size_t>(dims_.j),
             nk = static_cast<std::size_t>(dims_.k);
  for (std::size_t row = 0; row < nj * nk; ++row)
    spread_along(cells_between_, ni, 1, row * ni, line);
  for (std::size_t k = 0; k < nk; ++k) {
    for (std::size_t i = 0; i < ni; ++i)
      spread_along(cells_between_, nj, ni, k * ni * nj + i, line);
  }
  for (std::size_t column = 0; column < ni * nj; ++column) {
    spread_along(cells_between_, nk, ni * nj, column, line);
  }
}

double ClearanceMap::clearance_vox(const Vec3& grid) const noexcept {
  // The nearest point of the workspace is as near to everything in it as the point itself, or
  // nearer.
  const auto cell_along = [this](double x, std::int32_t cells) {
    const double last = static_cast<double>(cells) - 1;
    return static_cast<std::size_t>(std::clamp(std::floor(x / cell_), 0.0, last));
  };
  const std::size_t i = cell_along(grid.x(), dims_.i), j = cell_along(grid.y(), dims_.j),
                    k = cell_along(grid.z(), dims_.k);
  const int between = cells_between_[(k * static_cast<std::size_t>(dims_.j) + j) *
                                         static_cast<std::size_t>(dims_.i) +
                                     i];
  // From anywhere in a cell whose nearest occupied cell is n away, n - 1 whole cells lie between.
  // Interpolation reaches one voxel into empty space.
  const double within = static_cast<double>(between - 1) * cell_ - 1.0;
  const double outside = (-grid).cwiseMax(grid - size_).cwiseMax(0.0).norm() - 1.0;
  return std::max({0.0, within, outside});
}

}  // namespace vicinity
