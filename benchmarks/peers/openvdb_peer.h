// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// OpenVDB and NanoVDB doing our work, as one would who has them. Threads: those of the arena that
/// it is called in.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/viscosity/field.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity::peers {

/// Active voxels of q dilations, m steps each, over faces, edges and corners: the ranks of a cube.
/// @return  voxels beyond the boundary
std::uint64_t openvdb_dilations(const VoxelSet& boundary, int m, int q);

/// meshToVolume with a band of one voxel, and the mask of its interior.
/// @return  voxels within
std::uint64_t openvdb_voxels(const TriangleMesh& mesh, const Workspace& workspace);

/// The codes of a field as OpenVDB and as NanoVDB hold them, one float each, read through an
/// accessor, which remembers the nodes of the last lookup.
class VdbCodes {
 public:
  explicit VdbCodes(const ViscosityField& field);
  ~VdbCodes();

  double openvdb_sum(std::span<const VoxelIndex> voxels) const;
  double nanovdb_sum(std::span<const VoxelIndex> voxels) const;

 private:
  struct Grids;
  std::unique_ptr<Grids> grids_;
};

}  // namespace vicinity::peers
