// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "slabbed_mesh.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "geometry/whole_loops.h"

namespace vicinity {

// A counting sort by slab. Each piece of the mesh counts on its own, so that all pieces can then
// write at once, each to its own places, in the order of the mesh.
SlabbedMesh::SlabbedMesh(const TriangleMesh& mesh, const Workspace& workspace)
    : GridMesh(mesh, workspace) {
  if (mesh.triangles.empty()) return;
  const std::size_t triangles_per_piece = 1 << 14;
  const auto slabs = static_cast<std::size_t>(slab_end() - slab_begin());
  // No more counters than triangles, however many slabs there are.
  const std::size_t pieces =
      std::clamp<std::size_t>(triangle_count() / std::max(slabs, triangles_per_piece), 1, 64);
  const auto first_of = [&](std::size_t piece) { return triangle_count() * piece / pieces; };
  const auto visit = [&](std::size_t piece, auto&& entry) {
    for (std::size_t t = first_of(piece); t < first_of(piece + 1); ++t) {
      const auto& [a, b, c] = triangles()[t];
      const auto [low, high] =
          std::minmax({vertices()[a].z(), vertices()[b].z(), vertices()[c].z()});
      const auto last = static_cast<std::size_t>((floor_index(high) >> 3) - slab_begin());
      auto s = static_cast<std::size_t>((floor_index(low) >> 3) - slab_begin());
      for (; s <= last; ++s) entry(s, static_cast<std::uint32_t>(t));
    }
  };
  std::vector<std::vector<std::size_t>> next(pieces);
  whole::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
    next[piece].resize(slabs);
    visit(piece, [&](std::size_t slab, std::uint32_t) { ++next[piece][slab]; });
  });
  starts_.resize(slabs + 1);
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    std::size_t at = starts_[slab];
    for (std::vector<std::size_t>& counted : next) {
      const std::size_t count = counted[slab];
      counted[slab] = at;
      at += count;
    }
    starts_[slab + 1] = at;
  }
  listed_.resize(starts_.back());
  whole::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
    visit(piece, [&](std::size_t slab, std::uint32_t t) { listed_[next[piece][slab]++] = t; });
  });
}

SlabbedMesh::SlabbedMesh(const GridMesh& whole, std::span<const std::uint32_t> triangles,
                         const VoxelBox& within)
    : GridMesh(whole) {
  cut(within);
  if (box().empty()) return;
  const std::int32_t slabs = slab_end() - slab_begin();
  const auto slabs_of = [&](std::uint32_t t) {
    const std::array<Vec3, 3> corners = this->corners(t);
    const auto [low, high] = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
    const std::int32_t first = (floor_index(low) >> 3) - slab_begin();
    const std::int32_t end = (floor_index(high) >> 3) - slab_begin() + 1;
    return std::array{static_cast<std::size_t>(std::max(first, 0)),
                      static_cast<std::size_t>(std::clamp(end, 0, slabs))};
  };
  starts_.resize(static_cast<std::size_t>(slabs) + 1);
  for (const std::uint32_t t : triangles) {
    const auto [first, end] = slabs_of(t);
    for (std::size_t s = first; s < end; ++s) ++starts_[s + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  listed_.resize(starts_.back());
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  for (const std::uint32_t t : triangles) {
    const auto [first, end] = slabs_of(t);
    for (std::size_t s = first; s < end; ++s) listed_[next[s]++] = t;
  }
}

std::vector<std::uint32_t> SlabbedMesh::triangles_listed() const {
  std::vector<std::uint32_t> triangles = listed_;
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

}  // namespace vicinity
