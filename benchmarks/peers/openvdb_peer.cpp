// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The only unit that knows OpenVDB and NanoVDB.

#include "peers/openvdb_peer.h"

#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>

#include <vector>

namespace vicinity::peers {
namespace {

openvdb::Coord coord(const VoxelIndex& v) { return {v.i, v.j, v.k}; }

/// A mesh in voxels, which OpenVDB counts from their centres.
struct GridMesh {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;

  GridMesh(const TriangleMesh& mesh, const Workspace& workspace) {
    points.reserve(mesh.vertices.size());
    for (const Vec3& p : mesh.vertices) {
      const Vec3 g = workspace.to_grid(p) - Vec3::Constant(0.5);
      points.emplace_back(static_cast<float>(g.x()), static_cast<float>(g.y()),
                          static_cast<float>(g.z()));
    }
    triangles.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  }
};

}  // namespace

std::uint64_t openvdb_dilations(const VoxelSet& boundary, int m, int q) {
  openvdb::MaskTree tree;
  openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(tree);
  boundary.for_each([&](const VoxelIndex& v) { accessor.setValueOn(coord(v)); });
  const std::uint64_t before = tree.activeVoxelCount();
  for (int n = 0; n < q; ++n) {
    openvdb::tools::dilateActiveValues(tree, m, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                       openvdb::tools::IGNORE_TILES);
  }
  return tree.activeVoxelCount() - before;
}

std::uint64_t openvdb_voxels(const TriangleMesh& mesh, const Workspace& workspace) {
  openvdb::initialize();
  const GridMesh grid(mesh, workspace);
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(
      grid.points, grid.triangles);
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  const auto level_set =
      openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *transform, 1.0f, 1.0f);
  return openvdb::tools::sdfInteriorMask(*level_set)->activeVoxelCount();
}

struct VdbCodes::Grids {
  openvdb::FloatGrid::Ptr open;
  nanovdb::GridHandle<> nano;
};

VdbCodes::VdbCodes(const ViscosityField& field) : grids_(std::make_unique<Grids>()) {
  openvdb::initialize();
  grids_->open = openvdb::FloatGrid::create(0.0f);
  auto accessor = grids_->open->getAccessor();
  const VoxelIndex dims = field.workspace().dims;
  for (VoxelIndex v; v.k < dims.k; ++v.k) {
    for (v.j = 0; v.j < dims.j; ++v.j) {
      for (v.i = 0; v.i < dims.i; ++v.i) {
        if (const VoxelCode code = field.code_at(v)) accessor.setValue(coord(v), code);
      }
    }
    if (v.k % 128 == 127) openvdb::tools::prune(grids_->open->tree());
  }
  openvdb::tools::prune(grids_->open->tree());
  grids_->nano = nanovdb::openToNanoVDB(*grids_->open);
}

VdbCodes::~VdbCodes() = default;

double VdbCodes::openvdb_sum(std::span<const VoxelIndex> voxels) const {
  const auto accessor = grids_->open->getConstAccessor();
  double sum = 0;
  for (const VoxelIndex& v : voxels) sum += static_cast<double>(accessor.getValue(coord(v)));
  return sum;
}

double VdbCodes::nanovdb_sum(std::span<const VoxelIndex> voxels) const {
  const auto accessor = grids_->nano.grid<float>()->getAccessor();
  double sum = 0;
  for (const VoxelIndex& v : voxels) {
    sum += static_cast<double>(accessor.getValue(nanovdb::Coord(v.i, v.j, v.k)));
  }
  return sum;
}

}  // namespace vicinity::peers
