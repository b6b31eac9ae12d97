// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/parts.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "vicinity/mesh/placement.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity::report {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

// Primitives have their middle at the origin. A voxel is their metre here.
TriangleMesh at(const Vec3& middle, TriangleMesh mesh, double turn_degrees = 0) {
  return place(std::move(mesh), 1,
               pose_from_rpy(middle, {0, 0, turn_degrees * radians_per_degree}));
}

}  // namespace

Part cone() {
  return {"cone",
          at({cone_axis, cone_axis, cone_height / 2},
             primitive::cone(cone_base_radius, cone_height, 256)),
          {120, 120, 72}};
}

Part circular_cylinder() {
  return {"circular_cylinder", at({64, 64, 40}, primitive::cylinder(20, 40, 128)), {128, 128, 96}};
}

Part complex_cylinder() {
  return {"complex_cylinder",
          at({complex_cylinder_x, complex_cylinder_y, 40},
             primitive::complex_cylinder(complex_cylinder_radius, 40), -20),
          {200, 150, 104}};
}

Part hollow_cylinder() {
  return {"hollow_cylinder", at({80, 80, 40}, primitive::tube(36, 28, 40, 128)), {160, 160, 96}};
}

Part wedge() {
  return {"wedge",
          at({64.5, 64.5, (wedge_bottom + wedge_top) / 2},
             primitive::v_block({60, 60, wedge_top - wedge_bottom}, wedge_v_depth)),
          {128, 128, 108}};
}

Part cube() { return {"cube", at({30, 30, 30}, primitive::box({20, 20, 20})), {60, 60, 60}}; }

Part pentagonal_cylinder() {
  std::vector<std::array<double, 2>> corners;
  for (int n = 0; n < 5; ++n) {
    corners.push_back({24 * std::cos((90 + 72 * n) * radians_per_degree),
                       24 * std::sin((90 + 72 * n) * radians_per_degree)});
  }
  return {
      "pentagonal_cylinder", at({64, 64, 50}, primitive::extrusion(corners, 40)), {128, 128, 100}};
}

Part curved_cylinder() {
  return {"curved_cylinder", at({64, 64, 50}, primitive::cylinder(24, 40, 64)), {128, 128, 100}};
}

Part ball() {
  return {"ball",
          at(Vec3::Constant(ball_centre), primitive::sphere(ball_radius, 128)),
          {128, 128, 128}};
}

Part slot() {
  constexpr double width = 12;
  const Vec3 size(width, 40, 40), aside(slot_half_gap + width / 2, 0, 0);
  const Vec3 middle = Vec3::Constant(slot_middle);
  TriangleMesh both = at(middle - aside, primitive::box(size));
  const TriangleMesh right = at(middle + aside, primitive::box(size));
  const auto offset = static_cast<std::uint32_t>(both.vertices.size());
  both.vertices.insert(both.vertices.end(), right.vertices.begin(), right.vertices.end());
  for (const auto& [a, b, c] : right.triangles) {
    both.triangles.push_back({a + offset, b + offset, c + offset});
  }
  return {"slot", both, {80, 80, 80}};
}

Part post() {
  return {
      "post", at(Vec3::Constant(post_axis), primitive::cylinder(post_radius, 40)), {80, 80, 80}};
}

Part faceted_sphere(int segments) {
  return {
      "sphere_" + std::to_string(segments),
      at(Vec3::Constant(faceted_sphere_centre), primitive::sphere(faceted_sphere_radius, segments)),
      {128, 128, 128}};
}

}  // namespace vicinity::report
