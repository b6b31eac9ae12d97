// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "layers/nearest_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vicinity {
namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

}  // namespace

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double least = std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
  const Vec3 cross = (b - a).cross(c - a);
  // Thinner than a ten-millionth of its length: its sides are near enough, its normal is noise.
  const double longest2 =
      std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
  if (cross.norm() <= 1e-7 * longest2) return least;
  const Vec3 n = cross.normalized();
  // Over the triangle: the three signed areas seen from the foot of p agree.
  const auto side = [&](const Vec3& u, const Vec3& v) { return (v - u).cross(p - u).dot(n); };
  if (side(a, b) >= 0 && side(b, c) >= 0 && side(c, a) >= 0) {
    return std::min(least, std::abs((p - a).dot(n)));
  }
  return least;
}

double distance_to_mesh(const TriangleMesh& mesh, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    least = std::min(least,
                     distance_to_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  }
  return least;
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles_.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  }
  if (!triangles_.empty()) add_node(0, triangles_.size());
}

std::size_t TriangleTree::add_node(std::size_t begin, std::size_t end) {
  const std::size_t node = nodes_.size();
  nodes_.push_back({Box(), begin, end});
  for (std::size_t t = begin; t < end; ++t) {
    for (const Vec3& p : triangles_[t]) nodes_[node].box.extend(p);
  }
  if (end - begin > 4) {
    Eigen::Index axis = 0;
    nodes_[node].box.sizes().maxCoeff(&axis);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t t) {
      return triangles_.begin() + static_cast<std::ptrdiff_t>(t);
    };
    std::nth_element(at(begin), at(middle), at(end), [axis](const auto& s, const auto& t) {
      return s[0][axis] + s[1][axis] + s[2][axis] < t[0][axis] + t[1][axis] + t[2][axis];
    });
    const std::size_t left = add_node(begin, middle);
    const std::size_t right = add_node(middle, end);
    nodes_[node].left = left;
    nodes_[node].right = right;
  }
  return node;
}

double TriangleTree::distance(const Vec3& p, double limit) const {
  double least = limit;
  if (!nodes_.empty()) search(0, p, least);
  return least;
}

void TriangleTree::search(std::size_t index, const Vec3& p, double& least) const {
  const Node& node = nodes_[index];
  if (node.left == 0) {
    for (std::size_t t = node.begin; t < node.end; ++t) {
      const auto& [a, b, c] = triangles_[t];
      least = std::min(least, distance_to_triangle(p, a, b, c));
    }
    return;
  }
  std::size_t near = node.left, far = node.right;
  if (nodes_[far].box.squaredExteriorDistance(p) < nodes_[near].box.squaredExteriorDistance(p)) {
    std::swap(near, far);
  }
  for (const std::size_t child : {near, far}) {
    if (nodes_[child].box.exteriorDistance(p) < least) search(child, p, least);
  }
}

}  // namespace vicinity
