// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/boundary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <random>

#include "rounds.h"
#include "sets.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

const Workspace unit_grid{Vec3::Zero(), 1.0, {64, 64, 64}};

TriangleMesh one_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

// Whether a triangle meets the closed cube of half edge `half` about `centre`: no axis separates
// them. In 64-bit mantissas, where the code under test has 53 and clips.
bool meets_cube(const TriangleMesh& mesh, const Vec3& centre, double half) {
  using Real = long double;
  using V = Eigen::Matrix<Real, 3, 1>;
  std::array<V, 3> p;
  for (std::size_t c = 0; c < 3; ++c) p[c] = mesh.vertices[c].cast<Real>() - centre.cast<Real>();
  const std::array<V, 3> edges{p[1] - p[0], p[2] - p[1], p[0] - p[2]};
  std::vector<V> axes{V::UnitX(), V::UnitY(), V::UnitZ(), edges[0].cross(edges[1])};
  for (const V& edge : edges) {
    for (int a = 0; a < 3; ++a) axes.push_back(edge.cross(V::Unit(a)));
  }
  for (const V& axis : axes) {
    const auto [low, high] = std::minmax({axis.dot(p[0]), axis.dot(p[1]), axis.dot(p[2])});
    const Real reach = half * axis.cwiseAbs().sum();
    if (low > reach || high < -reach) return false;
  }
  return true;
}

// Every voxel of the triangle's box, grown by one, is marked where the triangle goes deeper than
// the grazing depth into it, and is not where it stays farther away than that.
void expect_exact(const TriangleMesh& mesh) {
  constexpr double grazing = 1e-9;
  const VoxelSet voxels = boundary_voxels(mesh, unit_grid);
  const VoxelBox box = voxels.box().grown(1);
  for (std::int32_t k = box.lo.k; k < box.hi.k; ++k) {
    for (std::int32_t j = box.lo.j; j < box.hi.j; ++j) {
      for (std::int32_t i = box.lo.i; i < box.hi.i; ++i) {
        const Vec3 centre = unit_grid.centre_of({i, j, k});
        if (voxels.contains({i, j, k})) {
          ASSERT_TRUE(meets_cube(mesh, centre, 0.5 + grazing)) << i << ' ' << j << ' ' << k;
        } else {
          ASSERT_FALSE(meets_cube(mesh, centre, 0.5 - grazing)) << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

TEST(Boundary, AgreesWithSeparatingAxesOnRandomTriangles) {
  for (unsigned seed = 1; seed <= test::rounds(400u); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const double reach = seed % 3 == 0 ? 1.5 : seed % 3 == 1 ? 6 : 25;
    std::uniform_real_distribution<double> offset(-reach, reach), origin(-40, 40);
    const Vec3 centre(origin(random), origin(random), origin(random));
    const auto vertex = [&] {
      return Vec3(centre + Vec3(offset(random), offset(random), offset(random)));
    };
    expect_exact(one_triangle(vertex(), vertex(), vertex()));
  }
}

TEST(Boundary, AgreesWithSeparatingAxesOnTrianglesOfAFineScan) {
  for (unsigned seed = 1; seed <= test::rounds(3000u); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> offset(-0.5, 0.5), origin(-9, 9);
    std::uniform_int_distribution<int> quarter(-2, 2);
    // Across the sides of blocks and slabs, too; some with corners and edges on the grid.
    const Vec3 centre =
        seed % 4 == 0 ? Vec3(64, 8, 8) : Vec3(origin(random), origin(random), origin(random));
    const double size = seed % 5 == 0 ? 2.2 : seed % 5 == 1 ? 0.1 : 1;
    const auto vertex = [&]() -> Vec3 {
      if (seed % 7 == 0) {
        return centre.array().round().matrix() +
               0.25 * Vec3(quarter(random), quarter(random), quarter(random));
      }
      return centre + size * Vec3(offset(random), offset(random), offset(random));
    };
    expect_exact(one_triangle(vertex(), vertex(), vertex()));
  }
}

TEST(Boundary, AgreesWithSeparatingAxesOnLongTriangles) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> offset(-60, 60);
    const auto vertex = [&] { return Vec3(offset(random), offset(random), offset(random) / 4); };
    expect_exact(one_triangle(vertex(), vertex(), vertex()));
  }
}

TEST(Boundary, AgreesWithSeparatingAxesOnSlivers) {
  for (unsigned seed = 1; seed <= test::rounds(200u); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> offset(-12, 12), width(-1, 1);
    const Vec3 a(offset(random), offset(random), offset(random));
    const Vec3 b(offset(random), offset(random), offset(random));
    const double thin = std::pow(10.0, -static_cast<double>(seed % 12));
    const Vec3 c =
        a + (b - a) * width(random) + thin * Vec3(width(random), width(random), width(random));
    expect_exact(one_triangle(a, b, c));
  }
}

TEST(Boundary, AgreesWithSeparatingAxesOnGridVerticesAndFlatTriangles) {
  for (unsigned seed = 1; seed <= test::rounds(300u); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> halves(-16, 16);
    TriangleMesh mesh = one_triangle(Vec3::Zero(), Vec3::Zero(), Vec3::Zero());
    for (Vec3& vertex : mesh.vertices) {
      vertex = 0.5 * Vec3(halves(random), halves(random), halves(random));
      // Two thirds lie in a plane along the grid, on or between its lines.
      if (seed % 3 != 0) vertex[seed % 4 % 3] = 0.5 * (static_cast<int>(seed % 7) - 3);
    }
    expect_exact(mesh);
  }
}

TEST(Boundary, HoldsTheVoxelOfEveryPointOfTheSurface) {
  for (const TriangleMesh& mesh :
       {primitive::sphere(0.7), primitive::torus(1, 0.2), primitive::box({0.3, 0.2, 0.0004}),
        primitive::v_block({0.1, 0.05, 0.07}, 0.03)}) {
    const Workspace workspace = grid_of(mesh, 80);
    const VoxelSet voxels = boundary_voxels(mesh, workspace);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> weight(0, 1);
    for (const auto& [a, b, c] : mesh.triangles) {
      for (int n = 0; n < 100; ++n) {
        // Square roots make the samples even; the corners and edges themselves come first.
        const double u = n < 3 ? (n == 0) : std::sqrt(weight(random));
        const double v = n < 3 ? (n == 1) : n < 20 ? 0 : weight(random);
        const Vec3 p =
            (1 - u) * mesh.vertices[a] + u * (1 - v) * mesh.vertices[b] + u * v * mesh.vertices[c];
        // The sample itself is rounded: a voxel within the grazing depth will do.
        bool held = false;
        for (int side = 0; side < 8; ++side) {
          const Vec3 towards(side & 1 ? 1 : -1, side & 2 ? 1 : -1, side & 4 ? 1 : -1);
          held |= voxels.contains(workspace.index_of(p + 1e-9 * workspace.voxel_size * towards));
        }
        ASSERT_TRUE(held) << p.transpose();
      }
    }
  }
}

TEST(Boundary, MarksOneLayerForAFaceOnAGridPlane) {
  const auto face = [](int axis, double at) {
    TriangleMesh mesh{{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    for (Vec3& p : mesh.vertices) {
      std::rotate(p.begin(), p.begin() + (2 - axis), p.end());
      p[axis] = at;
    }
    return mesh;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {3.0, 3.5, -2.0}) {
      SCOPED_TRACE(testing::Message() << axis << " at " << at);
      const VoxelSet voxels = boundary_voxels(face(axis, at), unit_grid);
      EXPECT_EQ(voxels.count(), 81u);  // the upper sides of the square belong to voxels 8
      voxels.for_each([&](const VoxelIndex& v) {
        EXPECT_EQ((std::array{v.i, v.j, v.k}[static_cast<std::size_t>(axis)]),
                  static_cast<int>(std::floor(at)));
      });
    }
  }
}

TEST(Boundary, MarksOneVoxelPerRowForAPlaneAt45Degrees) {
  for (int axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE(axis);
    TriangleMesh mesh{{{0, 0, 0.5}, {8, 8, 0.5}, {8, 8, 7.5}, {0, 0, 7.5}}, {{0, 1, 2}, {0, 2, 3}}};
    for (Vec3& p : mesh.vertices) std::rotate(p.begin(), p.begin() + axis, p.end());
    const VoxelSet voxels = boundary_voxels(mesh, unit_grid);
    EXPECT_EQ(voxels.count(), 72u);
    voxels.for_each([&](const VoxelIndex& v) {
      std::array<int, 3> index{v.i, v.j, v.k};
      std::rotate(index.begin(), index.begin() + (3 - axis) % 3, index.end());
      EXPECT_EQ(index[0], index[1]);
    });
  }
}

TEST(Boundary, MarksTheEdgesOfTrianglesWithoutArea) {
  const Vec3 a(0.5, 0.5, 0.5), b(6.5, 3.5, 9.25);
  const Triples line = triples(boundary_voxels(one_triangle(a, b, a), unit_grid));
  EXPECT_GE(line.size(), 10u);
  EXPECT_TRUE(line.contains({0, 0, 0}));
  EXPECT_TRUE(line.contains({6, 3, 9}));
  for (int n = 0; n <= 1000; ++n) {
    const VoxelIndex v = unit_grid.index_of(a + n / 1000.0 * (b - a));
    EXPECT_TRUE(line.contains({v.i, v.j, v.k}));
  }
  EXPECT_EQ(triples(boundary_voxels(one_triangle(a, 0.5 * (a + b), b), unit_grid)), line);
  EXPECT_EQ(triples(boundary_voxels(one_triangle(a, a, a), unit_grid)), (Triples{{0, 0, 0}}));
  EXPECT_EQ(boundary_voxels({}, unit_grid).count(), 0u);
}

TEST(Boundary, HasTheTightBoxOfTheMesh) {
  const VoxelSet voxels =
      boundary_voxels(one_triangle({-1.5, 2, 3}, {4, 5.5, 3}, {0, 0, 7.9}), unit_grid);
  EXPECT_EQ(voxels.box(), (VoxelBox{{-2, 0, 3}, {5, 6, 8}}));
}

TEST(Boundary, MovesWithTheMeshByWholeVoxels) {
  for (const BoundaryMethod method : {BoundaryMethod::exact, BoundaryMethod::probe}) {
    const TriangleMesh mesh = primitive::torus(10, 3.3, 24);
    TriangleMesh dyadic = mesh;
    for (Vec3& p : dyadic.vertices) p = (p * 1024).array().round() / 1024;
    const Triples here = triples(boundary_voxels(dyadic, unit_grid, method));
    const Triples there = triples(boundary_voxels(moved(dyadic, {-100, 7, 65}), unit_grid, method));
    Triples expected;
    for (const auto& [i, j, k] : here) expected.insert({i - 100, j + 7, k + 65});
    EXPECT_EQ(there, expected);
  }
}

TEST(Boundary, DependsNeitherOnTheOrderOfTrianglesNorOnThreads) {
  const TriangleMesh mesh = primitive::torus(1, 0.4, 40);
  const Workspace workspace = grid_of(mesh, 100);
  for (const BoundaryMethod method : {BoundaryMethod::exact, BoundaryMethod::probe}) {
    const Triples expected = triples(boundary_voxels(mesh, workspace, method));
    for (unsigned seed = 1; seed <= 5; ++seed) {
      EXPECT_EQ(triples(boundary_voxels(shuffled(mesh, seed), workspace, method)), expected);
    }
    for (const int threads : {1, 2}) {
      tbb::task_arena(threads).execute(
          [&] { EXPECT_EQ(triples(boundary_voxels(mesh, workspace, method)), expected); });
    }
  }
}

TEST(Boundary, ProbeMarksASubsetOfExact) {
  for (unsigned seed = 1; seed <= test::rounds(300u); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> offset(-9, 9);
    TriangleMesh mesh = one_triangle(Vec3::Zero(), Vec3::Zero(), Vec3::Zero());
    for (Vec3& p : mesh.vertices) {
      p = {offset(random), offset(random), offset(random)};
      if (seed % 2 == 0) p = p.array().round();
    }
    const VoxelSet exact = boundary_voxels(mesh, unit_grid);
    const VoxelSet probe = boundary_voxels(mesh, unit_grid, BoundaryMethod::probe);
    EXPECT_EQ(probe.box(), exact.box());
    probe.for_each([&](const VoxelIndex& v) {
      EXPECT_TRUE(exact.contains(v)) << v.i << ' ' << v.j << ' ' << v.k;
    });
  }
}

TEST(Boundary, ProbeMarksOneVoxelForEachGridLineThroughTheSurface) {
  // Of a flat plate each line through a voxel centre gives one voxel: eight by four lines.
  const TriangleMesh plate{{{0, 0, 2.3}, {8, 0, 2.3}, {8, 4, 2.3}, {0, 4, 2.3}},
                           {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_EQ(boundary_voxels(plate, unit_grid, BoundaryMethod::probe).count(), 32u);
  // z = x / 4: the brick is flattest along z, and the line through x = i + 1/2 meets z = (i + 1/2)
  // / 4.
  const TriangleMesh slope{{{0, 0, 0}, {8, 0, 2}, {8, 4, 2}, {0, 4, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  Triples expected;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 4; ++j) expected.insert({i, j, i / 4});
  }
  EXPECT_EQ(triples(boundary_voxels(slope, unit_grid, BoundaryMethod::probe)), expected);
}

TEST(Boundary, RefusesWhatCannotBeIndexed) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(boundary_voxels(one_triangle({0, 0, 0}, {1, nan, 0}, {0, 1, 0}), unit_grid), Error);
  EXPECT_THROW(boundary_voxels(one_triangle({0, 0, 0}, {1e7, 0, 0}, {0, 1, 0}), unit_grid), Error);
  EXPECT_THROW(boundary_voxels(one_triangle({4e9, 0, 0}, {4e9, 1, 0}, {4e9, 1, 1}), unit_grid),
               Error);
}

}  // namespace
}  // namespace vicinity
