// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "slabbed_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
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
    : triangles_(mesh.triangles), vertices_(mesh.vertices.size()) {
  if (mesh.triangles.empty()) return;
  tbb::parallel_for(std::size_t{0}, vertices_.size(),
                    [&](std::size_t v) { vertices_[v] = workspace.to_grid(mesh.vertices[v]); });

  Box bounds;
  for (const auto& triangle : triangles_) {
    for (const std::uint32_t corner : triangle) {
      if (!vertices_[corner].allFinite()) {
        throw Error({.where = "mesh",
                     .what = "a vertex is not a finite number of voxels from the origin",
                     .expected = "finite coordinates"});
      }
      bounds.extend(vertices_[corner]);
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

  const auto slabs_of = [&](const std::array<std::uint32_t, 3>& triangle) {
    const auto [low, high] = std::minmax(
        {vertices_[triangle[0]].z(), vertices_[triangle[1]].z(), vertices_[triangle[2]].z()});
    return std::array{static_cast<std::size_t>((floor_index(low) >> 3) - slab_begin()),
                      static_cast<std::size_t>((floor_index(high) >> 3) - slab_begin())};
  };
  starts_.resize(static_cast<std::size_t>(slab_end() - slab_begin()) + 1);
  for (const auto& triangle : triangles_) {
    const auto [first, last] = slabs_of(triangle);
    for (std::size_t s = first; s <= last; ++s) ++starts_[s + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  listed_.resize(starts_.back());
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const auto [first, last] = slabs_of(triangles_[t]);
    for (std::size_t s = first; s <= last; ++s) listed_[next[s]++] = t;
  }
}

}  // namespace vicinity
