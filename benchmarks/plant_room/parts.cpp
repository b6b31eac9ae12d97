// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "plant_room/parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vicinity/mesh/primitive.h"

namespace vicinity::benchmarks {
namespace {

using std::numbers::pi;

constexpr double bend_in_radii = 3;      // one and a half diameters, the common elbow
constexpr double flange_in_radii = 1.9;  // across, as a DN 50 weld neck of PN 16
constexpr double flanges_apart = 1.5;    // along a leg [m]
constexpr double gasket = 0.003;         // gap between two flanges [m]

/// Two weld neck flanges with a gasket's gap between them and eight bolts through both; axis along
/// z, origin in the gap.
TriangleMesh flange_pair(double radius, int segments) {
  const double rim = flange_in_radii * radius;
  const double thick = 0.01 + 0.2 * radius;
  const double neck = thick + 0.6 * radius;
  TriangleMesh pair;
  const TriangleMesh flange = primitive::revolution({{0, gasket / 2},
                                                     {rim, gasket / 2},
                                                     {rim, gasket / 2 + thick},
                                                     {1.3 * radius, gasket / 2 + thick},
                                                     {1.02 * radius, gasket / 2 + neck},
                                                     {0, gasket / 2 + neck}},
                                                    segments);
  append(pair, flange);
  append(pair, flange, axis_along(Vec3::Zero(), -Vec3::UnitZ()));

  constexpr int bolts = 8;
  const double circle = 0.8 * rim;
  const double bolt = 0.004 + 0.05 * radius;
  const double head = gasket / 2 + thick + bolt;
  const TriangleMesh hexagon = primitive::cylinder(1.8 * bolt, bolt, 6);
  const TriangleMesh shank = primitive::cylinder(bolt, 2 * head + bolt, std::max(8, segments / 4));
  for (int b = 0; b < bolts; ++b) {
    const double angle = 2 * pi * (b + 0.5) / bolts;
    const Vec3 p(circle * std::cos(angle), circle * std::sin(angle), 0);
    append(pair, shank, axis_along(p, Vec3::UnitZ()));
    for (const double side : {-1.0, 1.0}) {
      append(pair, hexagon,
             axis_along(p + side * (head - bolt / 2) * Vec3::UnitZ(), Vec3::UnitZ()));
    }
  }
  return pair;
}

}  // namespace

void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& X) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& p : part.vertices) mesh.vertices.push_back(X * p);
  for (const auto& [a, b, c] : part.triangles) {
    mesh.triangles.push_back({a + first, b + first, c + first});
  }
}

Pose axis_along(const Vec3& p, const Vec3& axis) {
  const Vec3 z = axis.normalized();
  const Vec3 x = z.unitOrthogonal();
  Pose X = Pose::Identity();
  X.linear() << x, z.cross(x), z;
  X.translation() = p;
  return X;
}

TriangleMesh flanged_pipe(const PipeLine& line, int segments) {
  const double bend = bend_in_radii * line.radius;
  TriangleMesh mesh = primitive::pipe(line.path, line.radius, bend, segments);
  const TriangleMesh flanges = flange_pair(line.radius, segments);
  const double room = 3 * line.radius + 0.04;  // between an elbow and the gap of a pair
  for (std::size_t leg = 0; leg + 1 < line.path.size(); ++leg) {
    const Vec3 from(line.path[leg].data()), to(line.path[leg + 1].data());
    const double length = (to - from).norm();
    const double begin = bend + room, end = length - bend - room;
    if (end - begin < 0.3) continue;
    const Vec3 ahead = (to - from) / length;
    const double spacing = std::min(flanges_apart, end - begin);
    for (double at = begin + line.first_flange * spacing; at < end; at += spacing) {
      append(mesh, flanges, axis_along(from + at * ahead, ahead));
    }
  }
  return mesh;
}

TriangleMesh dished_tank(double radius, double length, int segments) {
  const int steps = std::max(4, segments / 4);
  std::vector<std::array<double, 2>> profile;
  for (const double end : {-1.0, 1.0}) {
    for (int s = 0; s <= steps; ++s) {
      const double angle = pi / 2 * (end < 0 ? steps - s : s) / steps;
      const double r = angle == pi / 2 ? 0 : radius * std::cos(angle);
      profile.push_back({r, end * (length / 2 + radius / 2 * std::sin(angle))});
    }
  }
  TriangleMesh tank = primitive::revolution(profile, 2 * segments);
  // The weld seams of its shell stand out a little, as on real ones.
  for (double z = -length / 2; z < length / 2 + 1e-9; z += length / 3) {
    append(tank, primitive::tube(radius + 0.002, radius - 0.01, 0.012, 2 * segments),
           axis_along({0, 0, z}, Vec3::UnitZ()));
  }
  append(tank, flange_pair(0.14, segments),
         axis_along({0.3 * radius, 0, length / 2 + radius / 2 + 0.1}, Vec3::UnitZ()));
  append(tank, primitive::cylinder(0.14, 0.3, segments),
         axis_along({0.3 * radius, 0, length / 2 + radius / 2 - 0.05}, Vec3::UnitZ()));
  return tank;
}

TriangleMesh pump(int segments) {
  TriangleMesh mesh;
  append(mesh, primitive::box({0.95, 0.4, 0.06}), axis_along({0, 0, 0.03}, Vec3::UnitZ()));
  std::vector<std::array<double, 2>> profile = {{0, -0.22}};
  for (int fin = 0; fin < 12; ++fin) {
    const double z = -0.22 + 0.035 * fin;
    profile.push_back({0.15, z});
    profile.push_back({0.15, z + 0.008});
    profile.push_back({0.125, z + 0.008});
    profile.push_back({0.125, z + 0.035});
  }
  profile.push_back({0, profile.back()[1]});
  append(mesh, primitive::revolution(profile, segments),
         axis_along({-0.2, 0, 0.26}, Vec3::UnitX()));
  append(mesh,
         primitive::revolution({{0, -0.08},
                                {0.2, -0.08},
                                {0.22, -0.04},
                                {0.22, 0.04},
                                {0.2, 0.08},
                                {0.09, 0.1},
                                {0.09, 0.2},
                                {0, 0.2}},
                               segments),
         axis_along({0.28, 0, 0.28}, Vec3::UnitX()));
  append(mesh, primitive::cylinder(0.024, 0.3, segments),
         axis_along({0.08, 0, 0.26}, Vec3::UnitX()));
  append(mesh, flanged_pipe({{{0.28, 0, 0.4}, {0.28, 0, 0.85}, {0.28, 0.5, 0.85}}, 0.045, 0.5},
                            segments));
  return mesh;
}

}  // namespace vicinity::benchmarks
