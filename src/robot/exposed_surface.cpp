// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "exposed_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "vicinity/voxel/boundary.h"

namespace vicinity {
namespace {

constexpr double finest_m = 0.001;
constexpr double most_voxels = 8e6, most_along_an_axis = 2000;
constexpr double margin_vox = 2.5;  // so that the outside goes all round

/// A dense grid of bits, rows along x.
class Bits {
 public:
  explicit Bits(const VoxelIndex& dims)
      : dims_(dims),
        words_per_row_((static_cast<std::size_t>(dims.i) + 63) / 64),
        words_(words_per_row_ * static_cast<std::size_t>(dims.j) *
               static_cast<std::size_t>(dims.k)) {}

  std::size_t words_per_row() const noexcept { return words_per_row_; }
  std::uint64_t* row(std::int32_t j, std::int32_t k) noexcept {
    return &words_[(static_cast<std::size_t>(k) * static_cast<std::size_t>(dims_.j) +
                    static_cast<std::size_t>(j)) *
                   words_per_row_];
  }
  void set(const VoxelIndex& v) noexcept {
    row(v.j, v.k)[v.i / 64] |= std::uint64_t{1} << v.i % 64;
  }
  bool test(const VoxelIndex& v) noexcept { return (row(v.j, v.k)[v.i / 64] >> v.i % 64 & 1) != 0; }

 private:
  VoxelIndex dims_;
  std::size_t words_per_row_;
  std::vector<std::uint64_t> words_;
};

// Spreads bits along their row as far as it is free, in both directions.
std::uint64_t spread(std::uint64_t bits, std::uint64_t free) noexcept {
  std::uint64_t up = bits & free, down = up, up_free = free, down_free = free;
  for (int step = 1; step < 64; step *= 2) {
    up |= up_free & up << step;
    up_free &= up_free << step;
    down |= down_free & down >> step;
    down_free &= down_free >> step;
  }
  return up | down;
}

/// Fills the outside from the grid's corner. Each pass goes through all rows, there and back, and
/// takes along what it has just filled: few are needed.
class Flood {
 public:
  Flood(const VoxelIndex& dims, Bits& solid) : dims_(dims), solid_(solid), outside_(dims) {
    outside_.set({0, 0, 0});
    bool forward = true;
    while (pass(forward) || pass(!forward)) forward = !forward;
  }
  Bits& outside() noexcept { return outside_; }

 private:
  bool pass(bool forward) noexcept {
    bool changed = false;
    const std::int32_t rows = dims_.j * dims_.k;
    for (std::int32_t n = 0; n < rows; ++n) {
      const std::int32_t at = forward ? n : rows - 1 - n;
      changed |= fill_row(at % dims_.j, at / dims_.j);
    }
    return changed;
  }

  bool fill_row(std::int32_t j, std::int32_t k) noexcept {
    std::uint64_t* const row = outside_.row(j, k);
    const std::uint64_t* const solid = solid_.row(j, k);
    const std::size_t words = outside_.words_per_row();
    bool changed = false;
    for (std::size_t i = 0; i < words; ++i) {
      std::uint64_t bits = row[i];
      if (j > 0) bits |= outside_.row(j - 1, k)[i];
      if (j + 1 < dims_.j) bits |= outside_.row(j + 1, k)[i];
      if (k > 0) bits |= outside_.row(j, k - 1)[i];
      if (k + 1 < dims_.k) bits |= outside_.row(j, k + 1)[i];
      if (i > 0) bits |= row[i - 1] >> 63;
      if (i + 1 < words) bits |= row[i + 1] << 63;
      bits = spread(bits, ~solid[i]);
      changed |= bits != row[i];
      row[i] = bits;
    }
    return changed;
  }

  VoxelIndex dims_;
  Bits& solid_;
  Bits outside_;
};

// Whether a point of the triangle, of a net finer than a voxel, has the outside next to its voxel.
bool is_exposed(const Corners& triangle, const Workspace& grid, Bits& outside) {
  const auto next_to_outside = [&](const Vec3& p) {
    const VoxelIndex v = grid.index_of(p);
    for (std::int32_t k = v.k - 1; k <= v.k + 1; ++k) {
      for (std::int32_t j = v.j - 1; j <= v.j + 1; ++j) {
        for (std::int32_t i = v.i - 1; i <= v.i + 1; ++i) {
          if (outside.test({i, j, k})) return true;
        }
      }
    }
    return false;
  };
  const auto& [a, b, c] = triangle;
  const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
  const int steps = std::max(1, static_cast<int>(std::ceil(2 * longest / grid.voxel_size)));
  for (int u = 0; u <= steps; ++u) {
    for (int v = 0; u + v <= steps; ++v) {
      if (next_to_outside(a + (u * (b - a) + v * (c - a)) / steps)) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<Corners> exposed_surface(std::vector<Corners> triangles) {
  if (triangles.empty()) return triangles;
  Box box;
  TriangleMesh mesh;
  for (const Corners& corners : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.triangles.push_back({first, first + 1, first + 2});
    for (const Vec3& corner : corners) {
      mesh.vertices.push_back(corner);
      box.extend(corner);
    }
  }
  const double h = std::max({finest_m, box.sizes().maxCoeff() / most_along_an_axis,
                             std::cbrt(box.volume() / most_voxels)});
  if (!std::isfinite(h)) return triangles;  // too large to be anything: whoever samples it says so
  Workspace grid;
  grid.voxel_size = h;
  grid.origin = box.min() - Vec3::Constant(margin_vox * h);
  const Vec3 voxels = box.sizes() / h + Vec3::Constant(2 * margin_vox + 1);
  grid.dims = {static_cast<std::int32_t>(voxels.x()), static_cast<std::int32_t>(voxels.y()),
               static_cast<std::int32_t>(voxels.z())};
  Bits solid(grid.dims);
  boundary_voxels(mesh, grid).for_each([&](const VoxelIndex& v) { solid.set(v); });
  Flood flood(grid.dims, solid);
  std::erase_if(triangles, [&](const Corners& corners) {
    return !is_exposed(corners, grid, flood.outside());
  });
  return triangles;
}

}  // namespace vicinity
