// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <numbers>
#include <random>

#include "robots.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/urdf_file.h"

namespace vicinity {
namespace {

RobotModel one_link(std::vector<TriangleMesh> meshes) {
  RobotModel robot;
  robot.name = "one link";
  Link link{"link", {}};
  for (TriangleMesh& mesh : meshes) {
    link.geometries.push_back({LinkGeometry::Role::collision, std::move(mesh)});
  }
  robot.links.push_back(std::move(link));
  return robot;
}

double area_of(const RobotModel& robot) {
  return sample_body_points(robot, {.total = 200}).links.at(0).area;
}

TriangleMesh turned_inside_out(TriangleMesh mesh) {
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  return mesh;
}

constexpr double pi = std::numbers::pi;

TEST(ExposedSurface, OfABallWithAMotorInItIsTheBall) {
  const TriangleMesh ball = primitive::sphere(0.08);
  const double alone = area_of(one_link({ball}));
  EXPECT_NEAR(alone, 4 * pi * 0.08 * 0.08, 0.02 * alone);
  const TriangleMesh motor = primitive::cylinder(0.03, 0.06);
  EXPECT_EQ(area_of(one_link({ball, motor})), alone);
  // A hollow ball, whose inner wall is wound as CAD does it, with a motor in the hollow.
  const TriangleMesh wall = turned_inside_out(primitive::sphere(0.07));
  EXPECT_EQ(area_of(one_link({ball, wall, motor})), alone);
}

TEST(ExposedSurface, OfAThinWallIsBothItsSides) {
  const double alone = area_of(one_link({primitive::sphere(0.08)}));
  const TriangleMesh wall = turned_inside_out(primitive::sphere(0.0795));
  EXPECT_GT(area_of(one_link({primitive::sphere(0.08), wall})), 1.9 * alone);
}

TEST(ExposedSurface, OfATubeIsItsInsideToo) {
  const double R = 0.05, r = 0.03, height = 0.2;
  const double area = area_of(one_link({primitive::tube(R, r, height)}));
  const double whole = 2 * pi * (R + r) * height + 2 * pi * (R * R - r * r);
  EXPECT_NEAR(area, whole, 0.02 * whole);
}

// What can be touched is never left out, wherever the link lies in its frame and however slender.
TEST(ExposedSurface, OfAPlainShapeIsAllOfIt) {
  for (const Vec3& size : {Vec3(0.3, 0.0004, 0.0004), Vec3(0.2, 0.2, 0), Vec3(1.5, 0.4, 0.3)}) {
    TriangleMesh box = primitive::box(size.cwiseMax(1e-5));
    for (Vec3& v : box.vertices) v += Vec3(0.1234, -3.21, 0.777);
    double whole = 0;
    for (const auto& [a, b, c] : box.triangles) {
      whole +=
          0.5 * (box.vertices[b] - box.vertices[a]).cross(box.vertices[c] - box.vertices[a]).norm();
    }
    EXPECT_NEAR(area_of(one_link({box})), whole, 1e-9 * whole) << size.transpose();
  }
}

// Whether a ray meets a triangle (Möller and Trumbore).
bool meets(const Vec3& from, const Vec3& way, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, normal = way.cross(ac);
  const double along = ab.dot(normal);
  if (along == 0) return false;
  const Vec3 to = from - a, across = to.cross(ab);
  const double u = to.dot(normal) / along, v = way.dot(across) / along, t = ac.dot(across) / along;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 1e-9;
}

// By another route: what can be seen from far away can be touched, so that there must be points.
TEST(ExposedSurface, HoldsAllThatCanBeSeenOfRealArms) {
  for (const char* name : {kinova, fanuc, omni}) {
    SCOPED_TRACE(name);
    const auto file = robot_file(name);
    if (file.empty()) GTEST_SKIP() << "set VICINITY_DATA to the folder of real data";
    const RobotModel robot = read_urdf(file).robot;
    const BodyPoints points = sample_body_points(robot, {.points_per_m2 = 20'000});
    std::mt19937_64 random(1);
    double whole = 0, kept = 0;
    int seen = 0;
    for (const BodyPoints::LinkRange& range : points.links) {
      kept += range.area;
      const Link& link = robot.links[static_cast<std::size_t>(range.link)];
      for (const LinkGeometry& geometry : link.geometries) {
        const TriangleMesh& mesh = geometry.mesh;
        const auto corner = [&](std::size_t t, std::size_t n) {
          return mesh.vertices[mesh.triangles[t][n]];
        };
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
          whole += 0.5 * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm();
        }
        for (int sample = 0; sample < test::rounds(120); ++sample) {
          const std::size_t t = random() % mesh.triangles.size();
          const Vec3 centre = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3;
          const Vec3 way = random_vector(random).normalized();
          bool hidden = false;
          for (std::size_t other = 0; other < mesh.triangles.size() && !hidden; ++other) {
            hidden = other != t &&
                     meets(centre, way, corner(other, 0), corner(other, 1), corner(other, 2));
          }
          if (hidden) continue;
          ++seen;
          double nearest = 1;
          for (std::uint32_t p = range.begin; p < range.end; ++p) {
            nearest =
                std::min(nearest, (Vec3(points.x[p], points.y[p], points.z[p]) - centre).norm());
          }
          // Points are 7 mm apart.
          EXPECT_LT(nearest, 0.014)
              << link.name << ", triangle " << t << " at " << centre.transpose();
        }
      }
    }
    EXPECT_GT(seen, test::rounds(50));
    RecordProperty(robot.name + "_share_of_surface_kept", std::to_string(kept / whole));
    std::cout << robot.name << ": " << kept << " of " << whole << " m² can be reached\n";
  }
}

}  // namespace
}  // namespace vicinity
