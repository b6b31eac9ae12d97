// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "slabbed_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>

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
  tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
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
  tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
    visit(piece, [&](std::size_t slab, std::uint32_t t) { listed_[next[piece][slab]++] = t; });
  });
}

}  // namespace vicinity
