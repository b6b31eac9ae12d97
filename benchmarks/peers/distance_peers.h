// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Libraries that tell how far a point is from a mesh or from set voxels.
#pragma once

#include <memory>
#include <span>

#include "vicinity/geometry/vec3.h"
#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity::peers {

/// FCL: a bounding volume hierarchy, asked for its distance from a very small sphere.
class FclDistance {
 public:
  explicit FclDistance(const TriangleMesh& mesh);
  ~FclDistance();
  double sum(std::span<const Vec3> points) const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

/// CGAL: its tree of boxes over triangles.
class CgalDistance {
 public:
  explicit CgalDistance(const TriangleMesh& mesh);
  ~CgalDistance();
  double sum(std::span<const Vec3> points) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// dynamicEDT3D: distances of a whole array, made from its set voxels.
class DynamicEdt {
 public:
  DynamicEdt(const VoxelSet& boundary, const VoxelIndex& dims, int farthest);
  ~DynamicEdt();
  double sum(std::span<const VoxelIndex> voxels) const;

 private:
  struct Map;
  std::unique_ptr<Map> map_;
};

}  // namespace vicinity::peers
