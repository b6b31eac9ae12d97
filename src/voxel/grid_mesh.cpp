// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "grid_mesh.h"

#include <tbb/blocked_range.h>

#include <algorithm>
#include <limits>
#include <string>

#include "geometry/whole_loops.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

// As far as indices may go: far enough from 2^31 that boxes can grow, and where a double still
// resolves 2^-22 of a voxel.
constexpr double farthest_index = 1 << 30;

// As Workspace::covering() allows.
constexpr std::int32_t most_per_axis = 1 << 20;

// Triangles or vertices that a thread takes at a time: some hundred microseconds of work.
constexpr std::size_t vertices_a_task = 1 << 14;

struct Extent {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  bool finite = true;

  void add(const Vec3& p) {
    // A NaN leaves minimum and maximum alone, so it is looked for apart.
    finite &= p.allFinite();
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

Extent joined(Extent a, const Extent& b) {
  a.finite &= b.finite;
  a.low = a.low.cwiseMin(b.low);
  a.high = a.high.cwiseMax(b.high);
  return a;
}

}  // namespace

GridMesh::GridMesh(const TriangleMesh& mesh, const Workspace& workspace)
    : triangles_(mesh.triangles) {
  const auto vertices = std::make_shared<std::vector<Vec3>>(mesh.vertices.size());
  vertices_ = vertices;
  if (mesh.triangles.empty()) return;
  using Range = tbb::blocked_range<std::size_t>;
  whole::parallel_for(Range(0, vertices->size(), vertices_a_task), [&](const Range& range) {
    for (std::size_t v = range.begin(); v < range.end(); ++v) {
      (*vertices)[v] = workspace.to_grid(mesh.vertices[v]);
    }
  });
  const Extent extent = whole::parallel_reduce(
      Range(0, triangles_.size(), vertices_a_task), Extent{},
      [&](const Range& range, Extent sum) {
        for (std::size_t t = range.begin(); t < range.end(); ++t) {
          for (const std::uint32_t corner : triangles_[t]) sum.add((*vertices)[corner]);
        }
        return sum;
      },
      joined);
  if (!extent.finite) {
    throw Error({.where = "mesh",
                 .what = "a vertex is not a finite number of voxels from the origin",
                 .expected = "finite coordinates"});
  }
  reach_ = std::max(extent.low.cwiseAbs().maxCoeff(), extent.high.cwiseAbs().maxCoeff());
  const double longest = (extent.high - extent.low).maxCoeff();
  if (reach_ > farthest_index || longest > most_per_axis - 1) {
    throw Error({.where = "mesh",
                 .what = "too large for this voxel size",
                 .found = std::to_string(longest) + " voxels along its longest side, reaching " +
                          std::to_string(reach_) + " voxels from the origin",
                 .expected = "at most 1048576 voxels along each axis",
                 .hint = "larger voxels, or check the unit of the mesh"});
  }
  box_ = {{floor_index(extent.low.x()), floor_index(extent.low.y()), floor_index(extent.low.z())},
          {floor_index(extent.high.x()) + 1, floor_index(extent.high.y()) + 1,
           floor_index(extent.high.z()) + 1}};
}

}  // namespace vicinity
