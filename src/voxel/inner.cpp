// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/inner.h"

#include <tbb/blocked_range.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "consistent_winding.h"
#include "free_regions.h"
#include "geometry/whole_loops.h"
#include "inside.h"
#include "mesh_slice.h"
#include "open_edges.h"
#include "open_inner.h"
#include "slabbed_mesh.h"
#include "solid_angle.h"

namespace vicinity {
namespace {

// Winding number of a closed mesh about the centre of a voxel that is not boundary: outward less
// inward crossings of the line from there to x = infinity. No surface is within half a voxel of the
// centre, so that rounding cannot move a crossing to its other side.
int closed_winding_number(const SlabbedMesh& mesh, const VoxelIndex& v) {
  int crossings = 0;
  for (const std::uint32_t t : mesh.triangles_in(v.k >> 3)) {
    const std::optional<SliceSegment> segment = slice(mesh.corners(t), v.k + 0.5);
    if (!segment) continue;
    const std::optional<Crossing> crossing = cross(*segment, v.j + 0.5);
    if (crossing && crossing->x > v.i + 0.5) crossings += crossing->sign;
  }
  return crossings;
}

// The same of many voxels, for a mesh that is not listed by slabs: one walk over the triangles,
// each of which looks for the voxels in its layers.
std::vector<int> closed_winding_numbers(const GridMesh& mesh,
                                        const std::vector<VoxelIndex>& voxels) {
  std::vector<std::size_t> by_layer(voxels.size());
  std::iota(by_layer.begin(), by_layer.end(), std::size_t{0});
  std::sort(by_layer.begin(), by_layer.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(voxels[a].k, a) < std::pair(voxels[b].k, b);
  });
  std::vector<int> numbers(voxels.size());
  using Range = tbb::blocked_range<std::uint32_t>;
  const auto triangles = static_cast<std::uint32_t>(mesh.triangle_count());
  whole::parallel_for(Range(0, triangles, 1 << 12), [&](const Range& range) {
    for (std::uint32_t t = range.begin(); t < range.end(); ++t) {
      const std::array<Vec3, 3> corners = mesh.corners(t);
      const auto [low, high] = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
      auto at = std::partition_point(by_layer.begin(), by_layer.end(),
                                     [&, low = low](auto v) { return voxels[v].k + 0.5 < low; });
      for (; at != by_layer.end() && voxels[*at].k + 0.5 < high; ++at) {
        const VoxelIndex& v = voxels[*at];
        const std::optional<SliceSegment> segment = slice(corners, v.k + 0.5);
        if (!segment) continue;
        const std::optional<Crossing> crossing = cross(*segment, v.j + 0.5);
        if (!crossing || crossing->x <= v.i + 0.5) continue;
        std::atomic_ref(numbers[*at]).fetch_add(crossing->sign, std::memory_order_relaxed);
      }
    }
  });
  return numbers;
}

// Inner voxels where the winding number of a voxel is that of its whole region.
template <class AreInner>
VoxelSet closed_inner(const VoxelSet& boundary, AreInner&& are_inner) {
  VoxelSet inner(boundary.box());
  const FreeRegions regions(boundary);
  const std::vector<char> is_inner = are_inner(regions.voxels());
  whole::parallel_for(regions.slab_begin(), regions.slab_end(), [&](std::int32_t slab) {
    regions.visit_slab(
        slab, is_inner,
        [&](std::int32_t i_begin, std::int32_t i_end, std::int32_t j) {
          for (std::int32_t i = i_begin; i < i_end; ++i) {
            inner.blocks().make({i, j, slab}).words.fill(~std::uint64_t{0});
          }
        },
        [&](const BlockIndex& b, const BitBlock& part) {
          BitBlock& block = inner.blocks().make(b);
          for (std::size_t row = 0; row < 64; ++row) block.words[row] |= part.words[row];
        });
  });
  return inner;
}

// Even-odd in each row: voxels whose centre is past an odd number of crossings (§4.1.3).
VoxelSet raster_inner(const SlabbedMesh& mesh, const VoxelSet& boundary) {
  VoxelSet inner(boundary.box());
  const VoxelBox& box = boundary.box();
  if (box.empty()) return inner;
  whole::parallel_for(box.lo.k >> 3, ((box.hi.k - 1) >> 3) + 1, [&](std::int32_t slab) {
    std::vector<std::vector<double>> rows(static_cast<std::size_t>(box.hi.j - box.lo.j));
    for (std::int32_t k = slab * 8; k < slab * 8 + 8; ++k) {
      for (const std::uint32_t t : mesh.triangles_in(slab)) {
        const std::optional<SliceSegment> segment = slice(mesh.corners(t), k + 0.5);
        if (!segment) continue;
        const auto [low, high] = std::minmax(segment->from[1], segment->to[1]);
        for (std::int32_t j = std::max(floor_index(low), box.lo.j);
             j <= std::min(floor_index(high), box.hi.j - 1); ++j) {
          const std::optional<Crossing> crossing = cross(*segment, j + 0.5);
          if (crossing) rows[static_cast<std::size_t>(j - box.lo.j)].push_back(crossing->x);
        }
      }
      for (std::int32_t j = box.lo.j; j < box.hi.j; ++j) {
        std::vector<double>& crossings = rows[static_cast<std::size_t>(j - box.lo.j)];
        std::sort(crossings.begin(), crossings.end());
        // An open mesh may leave a last crossing without partner: nothing is filled beyond it.
        for (std::size_t c = 0; c + 1 < crossings.size(); c += 2) {
          const auto centre_past = [](double x) { return -floor_index(-(x - 0.5)); };
          inner.insert_run(centre_past(crossings[c]), centre_past(crossings[c + 1]), j, k);
        }
        crossings.clear();
      }
    }
    boundary.blocks().for_each_in_slab(slab, [&](const BlockIndex& b, const BitBlock& taken) {
      BitBlock* block = inner.blocks().find(b);
      if (block == nullptr) return;
      for (std::size_t row = 0; row < 64; ++row) block->words[row] &= ~taken.words[row];
    });
  });
  return inner;
}

}  // namespace

Inside::Inside(const TriangleMesh& mesh, const GridMesh& as_given, const SlabbedMesh* slabs,
               const Workspace& workspace, InnerMethod method)
    : method_(method), mesh_(&as_given), slabs_(slabs) {
  if (method != InnerMethod::winding || open_edges(as_given, 0).empty()) return;
  // Often a mesh is not open at all, but some of its triangles are wound the wrong way.
  turned_ = consistently_wound(mesh);
  if (slabs_ != nullptr) {
    auto slabbed = std::make_unique<const SlabbedMesh>(turned_, workspace);
    slabs_ = slabbed.get();
    turned_on_grid_ = std::move(slabbed);
  } else {
    turned_on_grid_ = std::make_unique<const GridMesh>(turned_, workspace);
  }
  mesh_ = turned_on_grid_.get();
  if (open_edges(*mesh_, 0).empty()) return;
  const std::vector<OpenEdge> edges = open_edges(*mesh_, crack_vox);
  is_open_ = !edges.empty();
  by_solid_angle_ = std::make_unique<const OpenInner>(*mesh_, edges);
}

Inside::~Inside() = default;

std::vector<char> Inside::are_inner(const std::vector<VoxelIndex>& voxels) const {
  std::vector<char> inner(voxels.size());
  if (by_solid_angle_ == nullptr && slabs_ == nullptr) {
    const std::vector<int> numbers = closed_winding_numbers(*mesh_, voxels);
    for (std::size_t v = 0; v < voxels.size(); ++v) inner[v] = numbers[v] != 0;
    return inner;
  }
  whole::parallel_for(std::size_t{0}, voxels.size(), [&](std::size_t v) {
    inner[v] = by_solid_angle_ ? by_solid_angle_->is_inner(voxels[v])
                               : closed_winding_number(*slabs_, voxels[v]) != 0;
  });
  return inner;
}

VoxelSet Inside::inner(const VoxelSet& boundary) const {
  switch (method_) {
    case InnerMethod::winding:
      if (is_open_) return by_solid_angle_->inner(boundary);
      return closed_inner(boundary,
                          [this](const std::vector<VoxelIndex>& v) { return are_inner(v); });
    case InnerMethod::raster:
      return raster_inner(*slabs_, boundary);
    case InnerMethod::none:
      break;
  }
  return VoxelSet(boundary.box());
}

std::optional<bool> Inside::throughout(const VoxelBox& box) const {
  switch (method_) {
    case InnerMethod::winding:
      return is_open_ ? by_solid_angle_->throughout(box) : are_inner({box.lo})[0] != 0;
    case InnerMethod::raster:
      return std::nullopt;
    case InnerMethod::none:
      break;
  }
  return false;
}

VoxelSet inner_voxels(const TriangleMesh& mesh, const VoxelSet& boundary,
                      const Workspace& workspace, InnerMethod method) {
  if (mesh.triangles.empty()) return VoxelSet(boundary.box());
  if (method == InnerMethod::raster) {
    const SlabbedMesh slabbed(mesh, workspace);
    return Inside(mesh, slabbed, &slabbed, workspace, method).inner(boundary);
  }
  return Inside(mesh, GridMesh(mesh, workspace), nullptr, workspace, method).inner(boundary);
}

double winding_number(const TriangleMesh& mesh, const Vec3& p_W) {
  SolidAngleSum sum;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum.add(mesh.vertices[a] - p_W, mesh.vertices[b] - p_W, mesh.vertices[c] - p_W);
  }
  return sum.value() / (4 * std::numbers::pi);
}

}  // namespace vicinity
