// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/primitive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "mesh_data.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

using std::numbers::pi;

/// Closed, consistently wound, every vertex used and met once, no triangle without area: counted
/// over a map of directed edges, which is not how inspect() does it.
void expect_sound(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::vector<bool> used(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++edges[{t[i], t[(i + 1) % 3]}];
      used.at(t[i]) = true;
    }
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3 b = mesh.vertices[t[1]] - a, c = mesh.vertices[t[2]] - a;
    ASSERT_GT(b.cross(c).norm(), 1e-9 * b.norm() * c.norm());
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), true), std::ssize(used));
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::vector<Vec3> sorted = mesh.vertices;
  std::sort(sorted.begin(), sorted.end(), less);
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
}

/// Area of a regular polygon with its corners on a circle.
double polygon_area(int corners, double radius) {
  return corners * radius * radius * std::sin(2 * pi / corners) / 2;
}

void expect_on_surface(const TriangleMesh& mesh, const std::function<double(const Vec3&)>& off) {
  for (const Vec3& p : mesh.vertices) ASSERT_NEAR(off(p), 0, 1e-12) << p.transpose();
}

double from_axis(const Vec3& p) { return std::hypot(p.x(), p.y()); }

TEST(Primitive, ABoxHasItsVolumeAndSize) {
  const TriangleMesh mesh = primitive::box(Vec3(1, 2, 3));
  expect_sound(mesh);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NEAR(volume(mesh), 6, 1e-12);
  EXPECT_EQ(mesh.bounds().min(), Vec3(-0.5, -1, -1.5));
  EXPECT_EQ(mesh.bounds().max(), Vec3(0.5, 1, 1.5));
}

TEST(Primitive, RoundShapesAreSoundAtEveryNumberOfSegments) {
  for (const int segments : {3, 4, 5, 6, 7, 8, 16, 31, 64, 200}) {
    SCOPED_TRACE(segments);
    expect_sound(primitive::sphere(0.3, segments));
    expect_sound(primitive::cylinder(0.3, 1, segments));
    expect_sound(primitive::capsule(0.3, 1, segments));
    expect_sound(primitive::cone(0.3, 1, segments));
    expect_sound(primitive::torus(0.3, 0.1, segments));
    expect_sound(primitive::tube(0.3, 0.1, 1, segments));
    expect_sound(primitive::pipe({{0, 0, 0}, {0, 0, 1}, {0, 1, 1}}, 0.05, 0.2, segments));
  }
}

TEST(Primitive, PrismsOfRevolutionHaveTheVolumeOfTheirPolygon) {
  for (const int n : {3, 6, 64}) {
    SCOPED_TRACE(n);
    EXPECT_NEAR(volume(primitive::cylinder(0.4, 1.5, n)), 1.5 * polygon_area(n, 0.4), 1e-12);
    EXPECT_NEAR(volume(primitive::cone(0.4, 1.5, n)), 1.5 * polygon_area(n, 0.4) / 3, 1e-12);
    EXPECT_NEAR(volume(primitive::tube(0.4, 0.3, 1.5, n)),
                1.5 * (polygon_area(n, 0.4) - polygon_area(n, 0.3)), 1e-12);
  }
}

TEST(Primitive, VolumesTendToTheTrueShape) {
  EXPECT_NEAR(volume(primitive::sphere(0.5, 400)) / (4.0 / 3 * pi * 0.125), 1, 2e-4);
  EXPECT_NEAR(volume(primitive::torus(0.5, 0.1, 400)) / (2 * pi * pi * 0.5 * 0.01), 1, 3e-4);
  EXPECT_LT(volume(primitive::sphere(0.5, 400)), 4.0 / 3 * pi * 0.125);
}

TEST(Primitive, VerticesOfRoundShapesLieOnTheTrueSurface) {
  expect_on_surface(primitive::sphere(0.5), [](const Vec3& p) { return p.norm() - 0.5; });
  expect_on_surface(primitive::torus(0.5, 0.1),
                    [](const Vec3& p) { return std::hypot(from_axis(p) - 0.5, p.z()) - 0.1; });
  expect_on_surface(primitive::cone(0.5, 2), [](const Vec3& p) {
    const bool centre_of_base = from_axis(p) == 0 && p.z() == -1;
    return centre_of_base ? 0 : from_axis(p) - 0.5 * (1 - p.z()) / 2;
  });
  expect_on_surface(primitive::capsule(0.5, 2), [](const Vec3& p) {
    const double beyond = std::max(std::abs(p.z()) - 1, 0.0);
    return std::hypot(p.x(), p.y(), beyond) - 0.5;
  });
  expect_on_surface(primitive::cylinder(0.5, 2), [](const Vec3& p) {
    return std::min(std::abs(from_axis(p) - 0.5), from_axis(p)) + std::abs(std::abs(p.z()) - 1);
  });
}

TEST(Primitive, RoundShapesAreExactlyAsWideAsAsked) {
  for (const TriangleMesh& mesh : {primitive::sphere(0.3), primitive::cylinder(0.3, 0.6)}) {
    EXPECT_EQ(mesh.bounds().min(), Vec3(-0.3, -0.3, -0.3));
    EXPECT_EQ(mesh.bounds().max(), Vec3(0.3, 0.3, 0.3));
  }
}

TEST(Primitive, AnExtrusionKeepsAreaAndSideWhicheverWayItsOutlineRuns) {
  std::vector<std::array<double, 2>> outline = {{0, 0}, {4, 0}, {4, 1}, {1, 1},
                                                {1, 2}, {4, 2}, {4, 3}, {0, 3}};
  for (int i = 0; i < 2; ++i) {
    const TriangleMesh mesh = primitive::extrusion(outline, 0.5);
    expect_sound(mesh);
    EXPECT_NEAR(volume(mesh), 0.5 * 9, 1e-12);
    std::reverse(outline.begin(), outline.end());
  }
}

TEST(Primitive, CornersOnAStraightEdgeMakeNoDegenerateTriangle) {
  const TriangleMesh mesh = primitive::extrusion(
      {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}, 1);
  expect_sound(mesh);
  EXPECT_NEAR(volume(mesh), 6, 1e-12);
}

TEST(Primitive, RandomStarOutlinesExtrudeToTheirArea) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> radius(0.2, 1.0);
    const int n = std::uniform_int_distribution<int>(3, 40)(random);
    std::vector<std::array<double, 2>> outline;
    double shoelace = 0;
    for (int i = 0; i < n; ++i) {
      const double r = radius(random), angle = 2 * pi * i / n;
      outline.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
      shoelace += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    const TriangleMesh mesh = primitive::extrusion(outline, 2);
    expect_sound(mesh);
    EXPECT_NEAR(volume(mesh), 2 * shoelace, 1e-12);
  }
}

TEST(Primitive, ARevolvedProfileObeysPappus) {
  // A flanged vessel: area times the way of its centroid, for a fine circle.
  const std::vector<std::array<double, 2>> profile = {{0, 0},     {0.2, 0},   {0.2, 0.4},
                                                      {0.3, 0.4}, {0.3, 0.5}, {0, 0.5}};
  const TriangleMesh mesh = primitive::revolution(profile, 1000);
  expect_sound(mesh);
  const double expected = pi * (0.04 * 0.4 + 0.09 * 0.1);
  EXPECT_NEAR(volume(mesh) / expected, 1, 1e-5);
}

TEST(Primitive, AProfileOffTheAxisClosesFromEndToStart) {
  const TriangleMesh ring =
      primitive::revolution({{0.1, 0}, {0.1, 0.3}, {0.2, 0.3}, {0.2, 0}}, 500);
  expect_sound(ring);
  EXPECT_NEAR(volume(ring) / (pi * (0.04 - 0.01) * 0.3), 1, 1e-4);
}

TEST(Primitive, APipeHasTheVolumeOfItsCentreLine) {
  // Two quarter elbows of radius 0.2 in different planes, a straight corner, and three legs.
  const TriangleMesh mesh = primitive::pipe(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1.5, 0}, {1, 1.5, 0.2}, {1, 1.5, 2}}, 0.05, 0.2, 256);
  expect_sound(mesh);
  const double straight = (1 - 0.2) + (1.5 - 0.4) + (2 - 0.2);
  const double bends = 2 * pi / 2 * 0.2;
  EXPECT_NEAR(volume(mesh) / (pi * 0.05 * 0.05 * (straight + bends)), 1, 1e-3);
}

TEST(Primitive, PipesWhoseElbowsTouchHaveNoDegenerateTriangle) {
  // The middle leg is exactly used up by its two elbows, the last one ends in its elbow.
  const TriangleMesh mesh =
      primitive::pipe({{0, 0, 0}, {1, 0, 0}, {1, 0.4, 0}, {1.2, 0.4, 0}}, 0.05, 0.2, 24);
  expect_sound(mesh);
}

TEST(Primitive, VerticesOfAnElbowLieOnItsTorus) {
  const TriangleMesh mesh = primitive::pipe({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 0.05, 0.3, 32);
  // The elbow turns about (0.7, 0.3), between x > 0.7 and y < 0.3.
  for (const Vec3& p : mesh.vertices) {
    if (p.x() < 0.7 + 1e-9 || p.y() > 0.3 - 1e-9) continue;
    ASSERT_NEAR(std::hypot(std::hypot(p.x() - 0.7, p.y() - 0.3) - 0.3, p.z()), 0.05, 1e-12);
  }
}

TEST(Primitive, TheVBlockLosesExactlyItsV) {
  const TriangleMesh mesh = primitive::v_block(Vec3(0.6, 0.4, 0.3), 0.2);
  expect_sound(mesh);
  EXPECT_NEAR(volume(mesh), 0.4 * (0.6 * 0.3 - 0.4 * 0.2 / 2), 1e-12);
  EXPECT_TRUE(mesh.bounds().sizes().isApprox(Vec3(0.6, 0.4, 0.3)));
  const bool junction = std::any_of(mesh.vertices.begin(), mesh.vertices.end(), [](const Vec3& p) {
    return p.x() == 0 && std::abs(p.z() - (0.15 - 0.2)) < 1e-12;
  });
  EXPECT_TRUE(junction) << "the V has its junction in the middle, at its depth";
}

TEST(Primitive, TheComplexCylinderHasOneNarrowAndFourWideConcavities) {
  const TriangleMesh mesh = primitive::complex_cylinder(1, 2);
  expect_sound(mesh);
  EXPECT_LT(mesh.bounds().sizes().x(), 2.0 + 1e-12);
  EXPECT_EQ(mesh.bounds().sizes().z(), 2.0);
  // Walk round the top: a concavity is a stretch of angles at which the rim is below the radius.
  std::map<double, double> rim;
  for (const Vec3& p : mesh.vertices) {
    // From 45 degrees on, which is no concavity, once round.
    const double angle = std::atan2(p.y(), p.x());
    if (p.z() > 0) rim[angle < pi / 4 ? angle + 2 * pi : angle] = from_axis(p);
  }
  int concavities = 0, narrow = 0;
  double begin = 0, deepest = 0;
  bool inside = false;
  for (const auto& [angle, radius] : rim) {
    ASSERT_LE(radius, 1 + 1e-12);
    const bool below = radius < 1 - 1e-9;
    if (below && !inside) begin = angle, deepest = 0;
    deepest = std::max(deepest, 1 - radius);
    if (!below && inside) {
      ++concavities;
      narrow += deepest > angle - begin;
    }
    inside = below;
  }
  EXPECT_EQ(concavities, 5);
  EXPECT_EQ(narrow, 1);
}

TEST(Primitive, SizesThatAreNoLengthsAreRefused) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    SCOPED_TRACE(bad);
    EXPECT_THROW(primitive::box(Vec3(1, bad, 1)), Error);
    EXPECT_THROW(primitive::sphere(bad), Error);
    EXPECT_THROW(primitive::cylinder(bad, 1), Error);
    EXPECT_THROW(primitive::cylinder(1, bad), Error);
    EXPECT_THROW(primitive::capsule(bad, 1), Error);
    EXPECT_THROW(primitive::capsule(1, bad), Error);
    EXPECT_THROW(primitive::cone(bad, 1), Error);
    EXPECT_THROW(primitive::torus(1, bad), Error);
    EXPECT_THROW(primitive::tube(1, bad, 1), Error);
    EXPECT_THROW(primitive::extrusion({{0, 0}, {1, 0}, {0, 1}}, bad), Error);
    EXPECT_THROW(primitive::pipe({{0, 0, 0}, {0, 0, 1}}, bad, 1), Error);
    EXPECT_THROW(primitive::v_block(Vec3(1, 1, 1), bad), Error);
    EXPECT_THROW(primitive::complex_cylinder(1, bad), Error);
  }
}

TEST(Primitive, ShapesThatCannotBeAreRefused) {
  EXPECT_THROW(primitive::sphere(1, 2), Error);
  EXPECT_THROW(primitive::sphere(1, 1 << 30), Error);
  EXPECT_THROW(primitive::torus(1, 1), Error);
  EXPECT_THROW(primitive::tube(1, 1, 1), Error);
  EXPECT_THROW(primitive::v_block(Vec3(1, 1, 1), 1), Error);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(primitive::extrusion({{0, 0}, {1, 0}, {0, nan}}, 1), Error);
  EXPECT_THROW(primitive::extrusion({{0, 0}, {1, 1}}, 1), Error) << "two points";
  EXPECT_THROW(primitive::extrusion({{0, 0}, {1, 1}, {2, 2}}, 1), Error) << "no area";
  EXPECT_THROW(primitive::extrusion({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 1), Error) << "crosses";
  EXPECT_THROW(primitive::extrusion({{0, 0}, {1, 0}, {1, 1}, {0, 0}}, 1), Error) << "repeats";
  EXPECT_THROW(primitive::extrusion({{0, 0}, {2, 0}, {1, 0}, {1, 1}}, 1), Error) << "turns back";
  EXPECT_THROW(primitive::revolution({{-1, 0}, {1, 0}, {0, 1}}), Error) << "crosses the axis";
  EXPECT_THROW(primitive::pipe({}, 0.1, 0.2), Error);
  EXPECT_THROW(primitive::pipe({{0, 0, 0}}, 0.1, 0.2), Error);
  EXPECT_THROW(primitive::pipe({{0, 0, 0}, {0, 0, 0}}, 0.1, 0.2), Error);
  EXPECT_THROW(primitive::pipe({{0, 0, 0}, {1, 0, 0}, {1, 0.1, 0}}, 0.05, 0.2), Error);
  EXPECT_THROW(primitive::pipe({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, 0.05, 0.2), Error) << "U-turn";
  EXPECT_THROW(primitive::pipe({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 0.3, 0.2), Error);
}

}  // namespace
}  // namespace vicinity
