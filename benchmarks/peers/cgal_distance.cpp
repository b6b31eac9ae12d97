// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The only unit that knows CGAL.

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <vector>

#include "peers/distance_peers.h"

namespace vicinity::peers {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct CgalDistance::Tree {
  Triangles triangles;
  Boxes boxes;
};

CgalDistance::CgalDistance(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>()) {
  for (const auto& [a, b, c] : mesh.triangles) {
    tree_->triangles.emplace_back(point(mesh.vertices[a]), point(mesh.vertices[b]),
                                  point(mesh.vertices[c]));
  }
  tree_->boxes.insert(tree_->triangles.begin(), tree_->triangles.end());
  tree_->boxes.accelerate_distance_queries();
}

CgalDistance::~CgalDistance() = default;

double CgalDistance::sum(std::span<const Vec3> points) const {
  double sum = 0;
  for (const Vec3& p : points) sum += std::sqrt(tree_->boxes.squared_distance(point(p)));
  return sum;
}

}  // namespace vicinity::peers
