// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The numbers that a voxel turns into when a field leaves for another program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vicinity/viscosity/field.h"

namespace vicinity {

/// What of a voxel.
enum class VoxelQuantity {
  rank,       ///< int16: boundary 0, ranks 1..q, empty -1, inner -2
  viscosity,  ///< float32: at the voxel's centre [N·s/m³]
  object,     ///< int16: index of the object, empty -1
  distance,   ///< float32: at least this far from the nearest surface [m]; NaN beyond the layers
};

/// "rank", "viscosity", "object" or "distance".
const char* to_string(VoxelQuantity quantity) noexcept;

/// Two bytes for int16, four for float32.
std::size_t size_of(VoxelQuantity quantity) noexcept;

/// The voxels of a grid that a box [m] has a share in; a corner on a voxel's face does not ask for
/// the voxel behind it.
VoxelBox voxels_within(const Workspace& grid, const Box& box) noexcept;

/// Which axis runs fastest in memory: x in VTK's images, z in a C-ordered array [x][y][z].
enum class Fastest { x, z };

/// The values of one quantity, plane by plane: the slowest axis counts the planes, so that no more
/// than one plane is ever in memory.
class VoxelPlanes {
 public:
  /// @param box  the voxels wanted, within the workspace of the field
  /// Errors: throws Error for distances of a field that keeps none.
  VoxelPlanes(const ViscosityField& field, const VoxelBox& box, VoxelQuantity quantity,
              Fastest fastest);

  std::int32_t count() const noexcept;
  /// The bytes of one plane, little-endian; good until the next call.
  const std::vector<std::byte>& plane(std::int32_t at);

 private:
  template <class Number, class ValueOf>
  void fill(std::int32_t at, ValueOf&& value_of);

  ViscosityField field_;
  VoxelBox box_;
  VoxelQuantity quantity_;
  Fastest fastest_;
  std::vector<std::byte> bytes_;
};

}  // namespace vicinity
