// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "slabbed_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <ranges>
#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

// As far as indices may go: far enough from 2^31 that boxes can grow, and where a double still
// resolves 2^-22 of a voxel.
constexpr double farthest_index = 1 << 30;

// As Workspace::covering() allows.
constexpr std::int32_t most_per_axis = 1 << 20;

}  // namespace

SlabbedMesh::SlabbedMesh(const TriangleMesh& mesh, const Workspace& workspace)
    : triangles_(mesh.triangles) {
  const auto vertices = std::make_shared<std::vector<Vec3>>(mesh.vertices.size());
  vertices_ = vertices;
  if (mesh.triangles.empty()) return;
  tbb::parallel_for(std::size_t{0}, vertices->size(),
                    [&](std::size_t v) { (*vertices)[v] = workspace.to_grid(mesh.vertices[v]); });

  Box bounds;
  for (const auto& triangle : triangles_) {
    for (const std::uint32_t corner : triangle) {
      const Vec3& p = (*vertices)[corner];
      if (!p.allFinite()) {
        throw Error({.where = "mesh",
                     .what = "a vertex is not a finite number of voxels from the origin",
                     .expected = "finite coordinates"});
      }
      bounds.extend(p);
    }
  }
  reach_ = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  const double longest = bounds.sizes().maxCoeff();
  if (reach_ > farthest_index || longest > most_per_axis - 1) {
    throw Error({.where = "mesh",
                 .what = "too large for this voxel size",
                 .found = std::to_string(longest) + " voxels along its longest side, reaching " +
                          std::to_string(reach_) + " voxels from the origin",
                 .expected = "at most 1048576 voxels along each axis",
                 .hint = "larger voxels, or check the unit of the mesh"});
  }
  box_ = {
      {floor_index(bounds.min().x()), floor_index(bounds.min().y()), floor_index(bounds.min().z())},
      {floor_index(bounds.max().x()) + 1, floor_index(bounds.max().y()) + 1,
       floor_index(bounds.max().z()) + 1}};
  list(std::views::iota(std::uint32_t{0}, static_cast<std::uint32_t>(triangles_.size())));
}

SlabbedMesh SlabbedMesh::part(std::span<const std::uint32_t> listed, const VoxelBox& within) const {
  SlabbedMesh part;
  part.triangles_ = triangles_;
  part.vertices_ = vertices_;
  part.reach_ = reach_;
  part.box_ = box_.within(within);
  if (!part.box_.empty()) part.list(listed);
  return part;
}

std::vector<std::uint32_t> SlabbedMesh::triangles_listed() const {
  std::vector<std::uint32_t> triangles = listed_;
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

template <class Indices>
void SlabbedMesh::list(const Indices& triangles) {
  const std::int32_t first_slab = slab_begin(), slabs = slab_end() - first_slab;
  const auto slabs_of = [&](std::uint32_t t) {
    const auto& [a, b, c] = triangles_[t];
    const auto [low, high] =
        std::minmax({(*vertices_)[a].z(), (*vertices_)[b].z(), (*vertices_)[c].z()});
    const std::int32_t first = (floor_index(low) >> 3) - first_slab;
    const std::int32_t last = (floor_index(high) >> 3) - first_slab;
    return std::array{static_cast<std::size_t>(std::max(first, 0)),
                      static_cast<std::size_t>(std::clamp(last + 1, 0, slabs))};
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

}  // namespace vicinity
