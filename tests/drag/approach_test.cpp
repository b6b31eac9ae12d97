// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/approach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "drag/fields.h"
#include "no_allocation.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

double degrees_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

struct Errors {
  double mean = 0, largest = 0;
};

// Against the radial direction, at random points of the layers around a sphere.
Errors errors_around_sphere(LayerShape layers, int m, int q, unsigned seed) {
  const double h = 0.01, radius = 30 * h;
  const ViscosityField field = field_around(primitive::sphere(radius, 128), layers, h, m, q);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> depth(1.8, 0.8 * q * m);
  Errors errors;
  int points = 0;
  while (points < 2000) {
    const Vec3 outward = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Vec3 p = (radius + h * depth(random)) * outward;
    // The sphere of radius 1 is an octahedron, whose layers are thinner along the diagonals.
    if (field.at(p).record.kind != VoxelKind::neighbour) continue;
    const Vec3 towards = towards_surface(field, p);
    EXPECT_NEAR(towards.norm(), 1, 1e-12);
    const double error = degrees_between(towards, -outward);
    errors.mean += error;
    errors.largest = std::max(errors.largest, error);
    ++points;
  }
  errors.mean /= points;
  return errors;
}

TEST(TowardsSurface, PointsToTheSphereWithinTheStatedError) {
  for (const auto& [m, stated_mean] : {std::pair{1, 6.5}, {2, 4.5}, {4, 3.5}}) {
    SCOPED_TRACE(::testing::Message() << "m = " << m);
    const Errors ranked = errors_around_sphere(LayerShape::sphere, m, 6, 7);
    EXPECT_LT(ranked.mean, stated_mean);
    EXPECT_LT(ranked.largest, 20);
    const Errors smooth = errors_around_sphere(LayerShape::distance, m, 6, 7);
    EXPECT_LT(smooth.mean, 0.2);
    // Right at the skin, where the distance is zero throughout a boundary voxel.
    EXPECT_LT(smooth.largest, 12);
  }
}

TEST(TowardsSurface, IsTheNormalOfAPlateOnBothSides) {
  for (const LayerShape layers : {LayerShape::cube, LayerShape::sphere, LayerShape::distance}) {
    SCOPED_TRACE(to_string(layers));
    // Much thinner than a voxel, as sheet metal is.
    const ViscosityField field = field_around(primitive::box({1, 1, 0.001}), layers, 0.01);
    for (double depth = 0.012; depth < 0.2; depth += 0.0031) {
      SCOPED_TRACE(depth);
      const Vec3 side(0.02, -0.03, 0);
      const Vec3 above = towards_surface(field, side + depth * Vec3::UnitZ());
      const Vec3 below = towards_surface(field, side - depth * Vec3::UnitZ());
      EXPECT_LT(degrees_between(above, -Vec3::UnitZ()), 1e-3) << above.transpose();
      EXPECT_LT(degrees_between(below, Vec3::UnitZ()), 1e-3) << below.transpose();
    }
  }
}

TEST(TowardsSurface, IsUnknownInEmptySpaceAndDeepInside) {
  for (const LayerShape layers : {LayerShape::sphere, LayerShape::distance}) {
    const ViscosityField field = field_around(primitive::box({0.8, 0.8, 0.8}), layers, 0.02, 2, 3);
    EXPECT_EQ(towards_surface(field, {0, 0, 0}), Vec3::Zero());
    EXPECT_EQ(towards_surface(field, {0, 0, 0.6}), Vec3::Zero());
    EXPECT_EQ(towards_surface(field, {50, 0, 0}), Vec3::Zero());
    EXPECT_EQ(towards_surface(field, {std::numeric_limits<double>::quiet_NaN(), 0, 0}),
              Vec3::Zero());
  }
}

TEST(TowardsSurface, IsUnknownHalfWayBetweenTwoWalls) {
  // A gap of 8 voxels between two blocks: ranks 1 and 1 in its middle.
  const ViscosityField field = painted_field({64, 64, 64}, [](const VoxelIndex& v) {
    const int depth = std::min(std::abs(v.i - 27), std::abs(v.i - 36));
    const bool solid = v.i <= 27 || v.i >= 36;
    return solid ? VoxelRecord{VoxelKind::inner, 0, 0}
                 : VoxelRecord{VoxelKind::neighbour, static_cast<std::uint8_t>((depth + 3) / 4), 0};
  });
  EXPECT_EQ(towards_surface(field, {32, 32, 32}), Vec3::Zero());
}

TEST(TowardsSurface, TakesNoMemoryFromTheHeap) {
  const ViscosityField ranked = field_around(primitive::box({1, 1, 1}), LayerShape::sphere, 0.05);
  const ViscosityField smooth = field_around(primitive::box({1, 1, 1}), LayerShape::distance, 0.05);
  const NoAllocation guard;
  EXPECT_NE(towards_surface(ranked, {0, 0, 0.7}), Vec3::Zero());
  EXPECT_NE(towards_surface(smooth, {0, 0, 0.7}), Vec3::Zero());
}

}  // namespace
}  // namespace vicinity
