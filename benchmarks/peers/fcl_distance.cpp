// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The only unit that knows FCL.

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/distance.h>

#include "peers/distance_peers.h"

namespace vicinity::peers {

struct FclDistance::Model {
  fcl::BVHModel<fcl::OBBRSSd> mesh;
};

FclDistance::FclDistance(const TriangleMesh& mesh) : model_(std::make_unique<Model>()) {
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  model_->mesh.beginModel();
  model_->mesh.addSubModel(mesh.vertices, triangles);
  model_->mesh.endModel();
}

FclDistance::~FclDistance() = default;

double FclDistance::sum(std::span<const Vec3> points) const {
  const fcl::Sphered point(1e-6);
  const fcl::DistanceRequestd request;
  double sum = 0;
  for (const Vec3& p : points) {
    fcl::DistanceResultd result;
    fcl::Transform3d X = fcl::Transform3d::Identity();
    X.translation() = p;
    sum += fcl::distance(&model_->mesh, fcl::Transform3d::Identity(), &point, X, request, result);
  }
  return sum;
}

}  // namespace vicinity::peers
