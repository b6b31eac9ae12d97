// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The only unit that knows dynamicEDT3D.

#include <dynamicEDT3D/dynamicEDT3D.h>

#include "peers/distance_peers.h"

namespace vicinity::peers {

struct DynamicEdt::Map : DynamicEDT3D {
  using DynamicEDT3D::DynamicEDT3D;
};

DynamicEdt::DynamicEdt(const VoxelSet& boundary, const VoxelIndex& dims, int farthest)
    : map_(std::make_unique<Map>(farthest * farthest)) {
  map_->initializeEmpty(dims.i, dims.j, dims.k);
  const VoxelBox box{{0, 0, 0}, dims};
  boundary.for_each([&](const VoxelIndex& v) {
    if (box.contains(v)) map_->occupyCell(v.i, v.j, v.k);
  });
  map_->update();
}

DynamicEdt::~DynamicEdt() = default;

double DynamicEdt::sum(std::span<const VoxelIndex> voxels) const {
  double sum = 0;
  for (const VoxelIndex& v : voxels) sum += static_cast<double>(map_->getDistance(v.i, v.j, v.k));
  return sum;
}

}  // namespace vicinity::peers
