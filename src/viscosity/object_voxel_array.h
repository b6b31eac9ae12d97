// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// One object alone on the grid, other objects absent: sparse, and as short as in a field's file.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "sparse_layer.h"
#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/viscosity/field.h"
#include "vicinity/viscosity/scene.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// The object voxel array, by regions of 64 x 64 x 64 voxels. Codes are object_code.
class ObjectVoxelArray {
 public:
  /// @param box  of the object and its layers; regions are those of the workspace's grid, and may
  ///             lie beyond it
  ObjectVoxelArray(const VoxelBox& box, int q, bool keeps_distance);

  /// First region along x, y, z, and how many there are.
  const VoxelIndex& lo() const noexcept { return lo_; }
  const VoxelIndex& size() const noexcept { return size_; }
  std::size_t cell_of(const VoxelIndex& region) const noexcept {
    return (static_cast<std::size_t>(region.k - lo_.k) * static_cast<std::size_t>(size_.j) +
            static_cast<std::size_t>(region.j - lo_.j)) *
               static_cast<std::size_t>(size_.i) +
           static_cast<std::size_t>(region.i - lo_.i);
  }
  bool holds(const VoxelIndex& region) const noexcept {
    return VoxelBox{lo_, {lo_.i + size_.i, lo_.j + size_.j, lo_.k + size_.k}}.contains(region);
  }

  /// References of a region in the array's layers.
  struct Reference {
    std::uint32_t codes, distances;
  };

  /// Takes a region up; set() then says where it stands.
  /// @param counts  its voxels by code, shape (object_code::count(q),)
  Reference put(const RegionDraft& draft, std::span<const std::uint64_t> counts);
  void set(const VoxelIndex& region, const Reference& reference,
           std::span<const std::uint64_t> counts);

  const SparseLayer& codes() const noexcept { return codes_; }
  const SparseLayer* distances() const noexcept { return distances_ ? &*distances_ : nullptr; }
  /// Voxels of a region by kind.
  VoxelCounts counts_of(std::uint32_t reference) const noexcept;
  /// Voxels of the whole array by code.
  std::span<const std::uint64_t> counts() const noexcept { return counts_; }

 private:
  VoxelIndex lo_, size_;
  SparseLayer codes_;
  std::optional<SparseLayer> distances_;
  std::vector<VoxelCounts> region_counts_;
  std::vector<std::uint64_t> counts_;
};

/// How long threads worked on each stage, all of them together [ns].
struct StageTimes {
  std::atomic<std::int64_t> voxelise = 0, fill = 0, rank = 0;
};

/// Triangles -> boundary -> inner -> ranks, tile by tile: what is held at one time is a few tiles
/// and the result. The same for any number of threads.
///
/// @param mesh    of the object, placed in W [m]
/// @param onward  called with how much is done, 0..1, from one thread at a time
/// Errors: throws Error as Voxeliser and ranked_neighbours().
ObjectVoxelArray object_voxel_array(const SceneObject& object, const TriangleMesh& mesh,
                                    const Workspace& workspace, StageTimes& times,
                                    const std::function<void(double done)>& onward);

}  // namespace vicinity
