// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/voxeliser.h"

#include "inside.h"
#include "slabbed_mesh.h"
#include "surface_voxels.h"
#include "triangle_bins.h"

namespace vicinity {

struct Voxeliser::Prepared {
  Prepared(const TriangleMesh& mesh, const Workspace& workspace, BoundaryMethod boundary,
           InnerMethod inner)
      : slabbed(mesh, workspace),
        bins(slabbed),
        inside(mesh, slabbed, &slabbed, workspace, inner),
        boundary_method(boundary) {}

  SlabbedMesh slabbed;
  TriangleBins bins;
  Inside inside;
  BoundaryMethod boundary_method;
};

Voxeliser::Voxeliser(const TriangleMesh& mesh, const Workspace& workspace, BoundaryMethod boundary,
                     InnerMethod inner)
    : prepared_(std::make_unique<const Prepared>(mesh, workspace, boundary, inner)) {}

Voxeliser::~Voxeliser() = default;
Voxeliser::Voxeliser(Voxeliser&&) noexcept = default;
Voxeliser& Voxeliser::operator=(Voxeliser&&) noexcept = default;

const VoxelBox& Voxeliser::box() const noexcept { return prepared_->slabbed.box(); }

VoxelSet Voxeliser::boundary(const VoxelBox& box) const {
  const std::vector<std::uint32_t> near = prepared_->bins.near(box);
  if (near.empty()) return VoxelSet(prepared_->slabbed.box().within(box));
  return surface_voxels(SlabbedMesh(prepared_->slabbed, near, box), prepared_->boundary_method);
}

VoxelSet Voxeliser::inner(const VoxelSet& boundary) const {
  return prepared_->inside.inner(boundary);
}

std::optional<bool> Voxeliser::inner_throughout(const VoxelBox& box) const {
  return prepared_->inside.throughout(box);
}

}  // namespace vicinity
