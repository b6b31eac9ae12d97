// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "triangle_bins.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vicinity {
namespace {

// About half a tile: smaller bins list large triangles too often, larger ones too many small ones.
constexpr int bin_shift = 7;

VoxelBox box_of(const std::array<Vec3, 3>& corners) {
  const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  return {{floor_index(low.x()), floor_index(low.y()), floor_index(low.z())},
          {floor_index(high.x()) + 1, floor_index(high.y()) + 1, floor_index(high.z()) + 1}};
}

}  // namespace

// Bins of the triangle's bounding box that its plane passes through, or nearly: a large triangle
// across the room is not listed in the whole room.
template <class Visit>
void TriangleBins::for_each_bin(std::uint32_t triangle, Visit&& visit) const {
  const std::array<Vec3, 3> corners = mesh_.corners(triangle);
  const VoxelBox box = box_of(corners);
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double half = 0.5 * (1 << bin_shift);
  // A little more than a bin: a boundary voxel may be marked within rounding of the plane.
  const double reach = (half + 1) * normal.cwiseAbs().sum();
  for (std::int32_t k = box.lo.k >> bin_shift; k <= (box.hi.k - 1) >> bin_shift; ++k) {
    for (std::int32_t j = box.lo.j >> bin_shift; j <= (box.hi.j - 1) >> bin_shift; ++j) {
      for (std::int32_t i = box.lo.i >> bin_shift; i <= (box.hi.i - 1) >> bin_shift; ++i) {
        const Vec3 centre = 2 * half * Vec3(i + 0.5, j + 0.5, k + 0.5);
        if (std::abs(normal.dot(centre - corners[0])) > reach) continue;
        visit(static_cast<std::size_t>(
            ((k - lo_.k) * std::int64_t{size_.j} + (j - lo_.j)) * size_.i + (i - lo_.i)));
      }
    }
  }
}

TriangleBins::TriangleBins(const SlabbedMesh& mesh) : mesh_(mesh) {
  const VoxelBox& box = mesh.box();
  if (box.empty()) return;
  lo_ = {box.lo.i >> bin_shift, box.lo.j >> bin_shift, box.lo.k >> bin_shift};
  size_ = {((box.hi.i - 1) >> bin_shift) - lo_.i + 1, ((box.hi.j - 1) >> bin_shift) - lo_.j + 1,
           ((box.hi.k - 1) >> bin_shift) - lo_.k + 1};
  starts_.resize(static_cast<std::size_t>(size_.i) * static_cast<std::size_t>(size_.j) *
                     static_cast<std::size_t>(size_.k) +
                 1);
  const auto count = static_cast<std::uint32_t>(mesh.triangle_count());
  for (std::uint32_t t = 0; t < count; ++t) {
    for_each_bin(t, [&](std::size_t bin) { ++starts_[bin + 1]; });
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  listed_.resize(starts_.back());
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  for (std::uint32_t t = 0; t < count; ++t) {
    for_each_bin(t, [&](std::size_t bin) { listed_[next[bin]++] = t; });
  }
}

std::vector<std::uint32_t> TriangleBins::near(const VoxelBox& box) const {
  std::vector<std::uint32_t> found;
  if (starts_.empty() || box.empty()) return found;
  const auto range = [](std::int32_t lo, std::int32_t hi, std::int32_t first, std::int32_t size) {
    return std::array{std::max(lo >> bin_shift, first),
                      std::min((hi - 1) >> bin_shift, first + size - 1)};
  };
  const auto [i_first, i_last] = range(box.lo.i, box.hi.i, lo_.i, size_.i);
  const auto [j_first, j_last] = range(box.lo.j, box.hi.j, lo_.j, size_.j);
  const auto [k_first, k_last] = range(box.lo.k, box.hi.k, lo_.k, size_.k);
  for (std::int32_t k = k_first; k <= k_last; ++k) {
    for (std::int32_t j = j_first; j <= j_last; ++j) {
      for (std::int32_t i = i_first; i <= i_last; ++i) {
        const auto bin = static_cast<std::size_t>(
            ((k - lo_.k) * std::int64_t{size_.j} + (j - lo_.j)) * size_.i + (i - lo_.i));
        for (std::size_t n = starts_[bin]; n < starts_[bin + 1]; ++n) {
          if (!box_of(mesh_.corners(listed_[n])).within(box).empty()) found.push_back(listed_[n]);
        }
      }
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace vicinity
