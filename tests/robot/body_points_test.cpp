// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/robot/body_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "robot/robots.h"
#include "rounds.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/robot/urdf_file.h"

namespace vicinity {
namespace {

using Role = LinkGeometry::Role;

// Distance by the closest of plane, edges and corners, one triangle after the other.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const Vec3 foot = p - normal.dot(p - a) * normal;
  const bool inside = (b - a).cross(foot - a).dot(normal) >= 0 &&
                      (c - b).cross(foot - b).dot(normal) >= 0 &&
                      (a - c).cross(foot - c).dot(normal) >= 0;
  if (inside) return (p - foot).norm();
  const auto to_edge = [&](const Vec3& from, const Vec3& to) {
    const Vec3 along = to - from;
    const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0., 1.);
    return (from + t * along - p).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

double distance_to_link(const Vec3& p, const Link& link) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const LinkGeometry& geometry : link.geometries) {
    for (const auto& [a, b, c] : geometry.mesh.triangles) {
      const auto& v = geometry.mesh.vertices;
      if ((v[b] - v[a]).cross(v[c] - v[a]).norm() == 0) continue;
      nearest = std::min(nearest, distance_to_triangle(p, v[a], v[b], v[c]));
    }
  }
  return nearest;
}

double link_area(const Link& link) {
  double area = 0;
  for (const LinkGeometry& geometry : link.geometries) {
    for (const auto& [a, b, c] : geometry.mesh.triangles) {
      const auto& v = geometry.mesh.vertices;
      area += (v[b] - v[a]).cross(v[c] - v[a]).norm() / 2;
    }
  }
  return area;
}

Vec3 point(const BodyPoints& points, std::size_t i) {
  return Eigen::Vector3f(points.x[i], points.y[i], points.z[i]).cast<double>();
}

RobotModel robot_of(const std::vector<TriangleMesh>& meshes) {
  RobotModel robot;
  for (const TriangleMesh& mesh : meshes) {
    const std::string number = std::to_string(robot.links.size());
    if (!robot.links.empty()) {
      robot.joints.emplace_back();
      robot.joints.back().name = "joint_" + number;
    }
    robot.links.push_back({"link_" + number, {{Role::collision, mesh}}});
  }
  return robot;
}

// Smallest distance of two points, in units of the distance in the densest possible packing.
double closeness(const BodyPoints& points, const BodyPoints::LinkRange& range) {
  const double count = range.end - range.begin;
  const double ideal = std::sqrt(2 * range.area / (std::numbers::sqrt3 * count));
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = range.begin; i < range.end; ++i) {
    for (std::size_t j = i + 1; j < range.end; ++j) {
      nearest = std::min(nearest, (point(points, i) - point(points, j)).norm());
    }
  }
  return nearest / ideal;
}

bool equal(const BodyPoints& a, const BodyPoints& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.area == b.area;
}

TEST(BodyPoints, LieOnTheSurfaceAndTheirSharesAddUpOnRealArms) {
  for (const char* name : {kinova, fanuc, omni}) {
    SCOPED_TRACE(name);
    const auto file = robot_file(name);
    if (file.empty()) GTEST_SKIP() << "set VICINITY_DATA to the folder of real data";
    const RobotModel robot = read_urdf(file).robot;
    BodyPointOptions options;
    options.total = 300;
    const BodyPoints points = sample_body_points(robot, options);
    EXPECT_EQ(points.count(), 300u);
    for (const BodyPoints::LinkRange& range : points.links) {
      const Link& link = robot.links[static_cast<std::size_t>(range.link)];
      double sum = 0;
      for (std::size_t i = range.begin; i < range.end; ++i) {
        EXPECT_LT(distance_to_link(point(points, i), link), 1e-6) << link.name;
        EXPECT_GT(points.area[i], 0);
        sum += points.area[i];
      }
      EXPECT_NEAR(sum, range.area, 1e-5 * range.area) << link.name;
      EXPECT_LE(range.area, link_area(link) * (1 + 1e-12)) << link.name;
    }
  }
}

TEST(BodyPoints, SharesAddUpToTheAreaWhateverTheNumberOfPoints) {
  const RobotModel robot = robot_of({primitive::sphere(0.1), primitive::torus(0.2, 0.03)});
  const double area = link_area(robot.links[0]) + link_area(robot.links[1]);
  for (const std::size_t total : {2u, 3u, 17u, 500u, 20000u}) {
    BodyPointOptions options;
    options.total = total;
    const BodyPoints points = sample_body_points(robot, options);
    EXPECT_EQ(points.count(), total);
    double sum = 0;
    for (const auto& range : points.links) sum += range.area;
    EXPECT_NEAR(sum, area, 1e-12 * area) << total;
  }
}

TEST(BodyPoints, KeepTheirDistanceFromEachOther) {
  // Elimination is known to reach 0.7 of the hexagonal packing on average; random points reach
  // 0.01.
  for (std::uint64_t seed = 0; seed < test::rounds(10u); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const RobotModel robot =
        robot_of({primitive::sphere(0.1), primitive::box({0.3, 0.2, 0.1}),
                  primitive::cylinder(0.05, 0.4), primitive::torus(0.2, 0.03)});
    BodyPointOptions options;
    options.total = 4000;
    options.seed = seed;
    const BodyPoints points = sample_body_points(robot, options);
    for (const auto& range : points.links) {
      EXPECT_GT(closeness(points, range), 0.6) << "link " << range.link;
    }
  }
}

TEST(BodyPoints, LeaveNoHoles) {
  // Every place on the surface has a point within one and a half packing distances.
  const RobotModel robot = robot_of({primitive::sphere(0.1)});
  BodyPointOptions options;
  options.total = 2000;
  const BodyPoints points = sample_body_points(robot, options);
  const double spacing = std::sqrt(2 * points.links[0].area / (std::numbers::sqrt3 * 2000));
  std::mt19937_64 random(5);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 place = 0.1 * random_vector(random).normalized();
    double nearest = 1;
    for (std::size_t k = 0; k < 2000; ++k) {
      nearest = std::min(nearest, (point(points, k) - place).norm());
    }
    EXPECT_LT(nearest, 1.1 * spacing);
  }
}

TEST(BodyPoints, MeasureAreaEvenlyEvenWhereTwoSidesShareTheirPoints) {
  // A plate thinner than the spacing: each end of it must weigh its own area, although points are
  // kept by distance in space and so are half as dense on each side.
  const RobotModel robot = robot_of({primitive::box({0.4, 0.4, 0.001})});
  for (std::uint64_t seed = 0; seed < test::rounds(10u); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    BodyPointOptions options;
    options.total = 2000;
    options.seed = seed;
    const BodyPoints points = sample_body_points(robot, options);
    // Drag of a layer that thins out linearly from one edge to the other: half the area's worth.
    double drag = 0;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      drag += points.area[i] * (0.5 + points.x[i] / 0.4);
    }
    const double area = link_area(robot.links[0]);
    EXPECT_NEAR(drag, area / 2, 0.003 * area);
  }
}

TEST(BodyPoints, DependOnTheSeedAndNotOnTheOrderOfTriangles) {
  RobotModel robot = robot_of({primitive::torus(0.2, 0.03), primitive::box({0.3, 0.2, 0.1})});
  const BodyPoints first = sample_body_points(robot, {.points_per_m2 = 5000, .seed = 4});
  EXPECT_TRUE(equal(first, sample_body_points(robot, {.points_per_m2 = 5000, .seed = 4})));
  EXPECT_FALSE(equal(first, sample_body_points(robot, {.points_per_m2 = 5000, .seed = 5})));
  std::mt19937_64 random(1);
  for (Link& link : robot.links) {
    auto& triangles = link.geometries[0].mesh.triangles;
    std::shuffle(triangles.begin(), triangles.end(), random);
    for (auto& triangle : triangles) {
      std::rotate(triangle.begin(), triangle.begin() + static_cast<int>(random() % 3),
                  triangle.end());
    }
  }
  EXPECT_TRUE(equal(first, sample_body_points(robot, {.points_per_m2 = 5000, .seed = 4})));
}

TEST(BodyPoints, OfOneLinkDoNotDependOnOtherLinks) {
  const RobotModel robot = robot_of({primitive::sphere(0.1), primitive::box({0.3, 0.2, 0.1})});
  const BodyPoints both = sample_body_points(robot, {});
  const BodyPoints alone = sample_body_points(robot, {.exclude = {"link_0"}});
  ASSERT_EQ(alone.links.size(), 1u);
  ASSERT_EQ(alone.links[0].link, 1);
  const auto& range = both.links[1];
  ASSERT_EQ(alone.count(), range.end - range.begin);
  for (std::size_t i = 0; i < alone.count(); ++i) {
    EXPECT_EQ(point(alone, i), point(both, range.begin + i));
  }
}

TEST(BodyPoints, CanBeWeightedLeftOutOrNamed) {
  const RobotModel robot = robot_of(
      {primitive::sphere(0.1), primitive::box({0.3, 0.2, 0.1}), primitive::torus(0.2, 0.03)});
  BodyPointOptions options;
  options.exclude = {"link_0"};
  options.weight = {{"link_1", 0.5}};
  options.named = {{"link_2", {.p_LR = {0.1, 0.2, 0.3}, .area = 0.04}}};
  const BodyPoints points = sample_body_points(robot, options);
  ASSERT_EQ(points.links.size(), 2u);
  EXPECT_EQ(points.links[0].link, 1);
  EXPECT_NEAR(points.links[0].area, 0.5 * link_area(robot.links[1]), 1e-12);
  EXPECT_EQ(points.links[0].end - points.links[0].begin, 440u);  // 0.22 m² at 2000 per m²
  EXPECT_EQ(points.links[1].link, 2);
  EXPECT_EQ(points.links[1].end - points.links[1].begin, 1u);
  EXPECT_LT((point(points, points.links[1].begin) - Vec3(0.1, 0.2, 0.3)).norm(), 1e-7);
  EXPECT_FLOAT_EQ(points.area[points.links[1].begin], 0.04f);

  options.points_per_m2 = 0;
  EXPECT_EQ(sample_body_points(robot, options).count(), 1u) << "the paper's single point";
}

TEST(BodyPoints, AreLaidOutForWholeVectors) {
  const RobotModel robot = robot_of(
      {primitive::sphere(0.1), primitive::box({0.3, 0.2, 0.1}), primitive::cylinder(0.02, 0.03)});
  const BodyPoints points = sample_body_points(robot, {.points_per_m2 = 3333});
  for (const auto* lane : {&points.x, &points.y, &points.z, &points.area}) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(lane->data()) % 64, 0u);
    EXPECT_EQ(lane->size() % BodyPoints::lane, 0u);
    EXPECT_EQ(lane->size(), points.x.size());
  }
  std::size_t cluster = 0, next = 0;
  for (const auto& range : points.links) {
    EXPECT_EQ(range.begin % BodyPoints::lane, 0u);
    for (; next < range.begin; ++next) EXPECT_EQ(points.area[next], 0) << "gaps have no area";
    EXPECT_EQ(range.first_cluster, cluster);
    for (; cluster < range.last_cluster; ++cluster) {
      EXPECT_EQ(points.clusters[cluster].begin, next);
      EXPECT_EQ((next - range.begin) % BodyPoints::cluster_size, 0u);
      next = points.clusters[cluster].end;
    }
    EXPECT_EQ(next, range.end);
  }
  EXPECT_EQ(cluster, points.clusters.size());
}

TEST(BodyPoints, ClustersAreCompactAndHoldTheirPoints) {
  const RobotModel robot = robot_of({primitive::sphere(0.1), primitive::box({0.3, 0.2, 0.1})});
  const BodyPoints points = sample_body_points(robot, {.points_per_m2 = 40000});
  const auto holds = [&](const BoundingSphere& sphere, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double distance = (point(points, i) - sphere.centre.cast<double>()).norm();
      EXPECT_LE(distance, static_cast<double>(sphere.radius));
    }
  };
  for (const auto& range : points.links) {
    holds(range.sphere, range.begin, range.end);
    // A round patch of 64 points has this radius; two to one is as good as cuts along axes get.
    const double patch = std::sqrt(64 * range.area / (range.end - range.begin) / std::numbers::pi);
    double sum = 0;
    for (auto c = range.first_cluster; c < range.last_cluster; ++c) {
      holds(points.clusters[c].sphere, points.clusters[c].begin, points.clusters[c].end);
      sum += static_cast<double>(points.clusters[c].sphere.radius);
    }
    EXPECT_LT(sum / (range.last_cluster - range.first_cluster), 2 * patch);
  }
  EXPECT_NEAR(points.links[0].sphere.radius, 0.1, 0.002) << "of a whole ball";
}

TEST(BodyPoints, SliversAndSpecksAreSampledLikeAnySurface) {
  for (const Vec3& corner : {Vec3(0, 1e-12, 0), Vec3(0, 1e-60, 0), Vec3(1, 1e-9, 0)}) {
    for (const double length : {1e9, 1., 1e-60}) {
      const TriangleMesh sliver{{{0, 0, 0}, {length, 0, 0}, corner}, {{0, 1, 2}}};
      const RobotModel robot = robot_of({sliver});
      const double area = link_area(robot.links[0]);
      const BodyPoints points = sample_body_points(robot, {.total = 10});
      ASSERT_EQ(points.links.size(), area > 0 ? 1u : 0u);
      for (const auto& range : points.links) EXPECT_NEAR(range.area, area, 1e-12 * area);
    }
  }
}

TEST(BodyPoints, WhatCannotBeMeantIsRefused) {
  const RobotModel robot = robot_of({primitive::sphere(0.1)});
  const double nan = std::nan("");
  EXPECT_THROW(sample_body_points(robot, {.points_per_m2 = -1}), Error);
  EXPECT_THROW(sample_body_points(robot, {.points_per_m2 = nan}), Error);
  EXPECT_THROW(sample_body_points(robot, {.points_per_m2 = 1e12}), Error);
  EXPECT_THROW(sample_body_points(robot_of({primitive::box({1e200, 1e200, 1})}), {.total = 9}),
               Error);
  EXPECT_THROW(sample_body_points(robot, {.exclude = {"elbow"}}), Error);
  EXPECT_THROW(sample_body_points(robot, {.weight = {{"elbow", 1}}}), Error);
  EXPECT_THROW(sample_body_points(robot, {.weight = {{"link_0", -1}}}), Error);
  EXPECT_THROW(sample_body_points(robot, {.named = {{"link_0", {.area = nan}}}}), Error);
  EXPECT_THROW(sample_body_points(robot, {.named = {{"link_0", {.p_LR = {nan, 0, 0}}}}}), Error);
}

TEST(BodyPoints, AMeshInMillimetresIsRefusedAtOnceWithItsAreaAndDensity) {
  // A box of 0.2 m, taken for 200 m.
  const RobotModel robot = robot_of({primitive::box({200, 200, 200})});
  try {
    sample_body_points(robot);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("4.8e+08 on 2.4e+05 m² of surface, 2000 on each"));
    EXPECT_THAT(error.what(), testing::HasSubstr("of millimetres"));
  }
  EXPECT_THROW(sample_body_points(robot, {.total = BodyPoints::most + 1}), Error);
}

TEST(BodyPoints, ARobotWithoutSurfaceHasNone) {
  RobotModel robot;
  robot.links.push_back({"frame", {}});
  EXPECT_EQ(sample_body_points(robot, {}).count(), 0u);
  // One triangle, and it has no area.
  TriangleMesh line{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  robot.links[0].geometries.push_back({Role::visual, line});
  EXPECT_EQ(sample_body_points(robot, {}).count(), 0u);
}

}  // namespace
}  // namespace vicinity
