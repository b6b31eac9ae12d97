// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/inner.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "rounds.h"
#include "sets.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/voxel/boundary.h"

namespace vicinity {
namespace {

struct Voxelised {
  Workspace workspace;
  VoxelSet boundary, inner;
};

Voxelised voxelised(const TriangleMesh& mesh, const Workspace& workspace,
                    InnerMethod method = InnerMethod::winding) {
  Voxelised result{workspace, boundary_voxels(mesh, workspace), VoxelSet()};
  result.inner = inner_voxels(mesh, result.boundary, workspace, method);
  return result;
}

Voxelised voxelised(const TriangleMesh& mesh, int n, InnerMethod method = InnerMethod::winding) {
  return voxelised(mesh, grid_of(mesh, n), method);
}

void visit(const VoxelBox& box, const std::function<void(const VoxelIndex&)>& visitor) {
  for (std::int32_t k = box.lo.k; k < box.hi.k; ++k) {
    for (std::int32_t j = box.lo.j; j < box.hi.j; ++j) {
      for (std::int32_t i = box.lo.i; i < box.hi.i; ++i) visitor({i, j, k});
    }
  }
}

// Every voxel off the boundary is inner just where the solid holds its centre.
void expect_solid(const Voxelised& v, const std::function<bool(const Vec3&)>& solid) {
  EXPECT_EQ(v.inner.box(), v.boundary.box());
  std::size_t wrong = 0;
  visit(v.boundary.box().grown(2), [&](const VoxelIndex& index) {
    const bool expected = !v.boundary.contains(index) && solid(v.workspace.centre_of(index));
    wrong += v.inner.contains(index) != expected;
  });
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(v.inner.count(), 0u);
}

// Inner voxels fit into the solid, and with the boundary they cover it.
void expect_volume(const Voxelised& v, double volume) {
  const double h3 = std::pow(v.workspace.voxel_size, 3);
  EXPECT_LE(static_cast<double>(v.inner.count()) * h3, volume);
  EXPECT_GE(static_cast<double>(v.inner.count() + v.boundary.count()) * h3, volume);
}

const InnerMethod filling[] = {InnerMethod::winding, InnerMethod::raster};

TEST(Inner, FillsABallToItsVolume) {
  const TriangleMesh mesh = primitive::sphere(1, 96);
  for (const InnerMethod method : filling) {
    const Voxelised v = voxelised(mesh, 90, method);
    // Within the ball but for the sagitta of a facet, which lies inside the boundary.
    expect_solid(v, [](const Vec3& p) { return p.norm() < 1; });
    expect_volume(v, 4.0 / 3 * std::numbers::pi);
  }
}

TEST(Inner, FillsATorusButNotItsHole) {
  const TriangleMesh mesh = primitive::torus(1, 0.35, 96);
  for (const InnerMethod method : filling) {
    const Voxelised v = voxelised(mesh, 100, method);
    expect_solid(
        v, [](const Vec3& p) { return std::hypot(std::hypot(p.x(), p.y()) - 1, p.z()) < 0.35; });
    expect_volume(v, 2 * std::numbers::pi * std::numbers::pi * 0.35 * 0.35);
  }
}

TEST(Inner, LeavesACavityEmpty) {
  const TriangleMesh mesh = joined(primitive::box({4, 4, 4}), inverted(primitive::box({2, 2, 2})));
  for (const InnerMethod method : filling) {
    const Voxelised v = voxelised(mesh, 80, method);
    expect_solid(v, [](const Vec3& p) {
      return p.cwiseAbs().maxCoeff() < 2 && p.cwiseAbs().maxCoeff() > 1;
    });
    expect_volume(v, 64 - 8);
  }
}

TEST(Inner, FillsNestedShellsOfOneWindingThroughout) {
  const TriangleMesh mesh = joined(primitive::sphere(1), primitive::sphere(0.5));
  expect_solid(voxelised(mesh, 70), [](const Vec3& p) { return p.norm() < 1; });
}

TEST(Inner, RasterLeavesTheInnerOfTwoNestedShellsEmpty) {
  const TriangleMesh mesh = joined(primitive::sphere(1), primitive::sphere(0.5));
  expect_solid(voxelised(mesh, 70, InnerMethod::raster),
               [](const Vec3& p) { return p.norm() < 1 && p.norm() > 0.5; });
}

TEST(Inner, FillsWhatOverlapsAndWhatIsWoundInward) {
  const TriangleMesh a = primitive::box({2, 2, 2});
  const TriangleMesh b = moved(primitive::box({2, 2, 2}), {1.25, 1.25, 0.5});
  const auto either = [](const Vec3& p) {
    return p.cwiseAbs().maxCoeff() < 1 || (p - Vec3(1.25, 1.25, 0.5)).cwiseAbs().maxCoeff() < 1;
  };
  expect_solid(voxelised(joined(a, b), 60), either);
  expect_solid(voxelised(inverted(joined(a, b)), 60), either);
}

TEST(Inner, GivesNothingInsideADoubledSurface) {
  const TriangleMesh ball = primitive::sphere(1, 32);
  TriangleMesh doubled = ball;
  for (const auto& [a, b, c] : ball.triangles) doubled.triangles.push_back({a, c, b});
  EXPECT_EQ(voxelised(doubled, 40).inner.count(), 0u);
  EXPECT_EQ(voxelised(joined(ball, inverted(ball)), 40).inner.count(), 0u);
}

TEST(Inner, GivesNothingWhereNothingIsAsked) {
  EXPECT_EQ(voxelised(primitive::sphere(1), 40, InnerMethod::none).inner.count(), 0u);
  const Workspace workspace{Vec3::Zero(), 0.1, {10, 10, 10}};
  for (const InnerMethod method : filling) {
    EXPECT_EQ(inner_voxels({}, VoxelSet(), workspace, method).count(), 0u);
  }
}

TEST(Inner, FillsABoxOfManyBlocksWithFacesOnTheGrid) {
  // Rows through vertices, edges and along faces: nothing may leak or be lost.
  TriangleMesh mesh = primitive::box({150, 20, 20});
  const Workspace workspace{Vec3(-75, -10, -10), 1, {150, 20, 20}};
  for (const InnerMethod method : filling) {
    for (const Vec3& by : {Vec3(0, 0, 0), Vec3(0.5, 0.5, 0.5), Vec3(0.5, 0, -0.5)}) {
      const Voxelised v = voxelised(moved(mesh, by), workspace, method);
      const std::size_t on_grid = 149u * 19 * 19;
      EXPECT_GE(v.inner.count(), on_grid);
      EXPECT_LE(v.inner.count(), on_grid);
    }
  }
}

TEST(Inner, AgreesWithTheWindingNumberOfEveryVoxelOfOpenMeshes) {
  struct Case {
    const char* name;
    TriangleMesh mesh;
  };
  TriangleMesh punctured = primitive::sphere(1, 24);
  punctured.triangles.resize(punctured.triangles.size() - 20);
  TriangleMesh lidless = primitive::box({2, 2, 2});
  lidless.triangles.resize(10);
  TriangleMesh soup;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (std::uint32_t t = 0; t < 40; ++t) {
    for (int n = 0; n < 3; ++n) {
      soup.vertices.push_back({coordinate(random), coordinate(random), coordinate(random)});
    }
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  for (const Case& c : {Case{"punctured", punctured}, Case{"lidless", lidless}, Case{"soup", soup},
                        Case{"two", joined(lidless, moved(punctured, {0.7, 0.3, 1}))}}) {
    SCOPED_TRACE(c.name);
    const Voxelised v = voxelised(c.mesh, 30);
    std::size_t wrong = 0;
    visit(v.boundary.box(), [&](const VoxelIndex& index) {
      const double size = std::abs(winding_number(c.mesh, v.workspace.centre_of(index)));
      if (v.boundary.contains(index)) {
        wrong += v.inner.contains(index);
      } else if (std::abs(size - 0.5) > 0.005) {  // what far pieces may be off
        wrong += v.inner.contains(index) != (size > 0.5);
      }
    });
    EXPECT_EQ(wrong, 0u);
  }
}

TEST(Inner, FillsABallOfWhichSomeTrianglesAreWoundTheWrongWay) {
  TriangleMesh flipped = primitive::sphere(1, 48);
  for (std::size_t t = 0; t < flipped.triangles.size(); t += 3) {
    std::swap(flipped.triangles[t][0], flipped.triangles[t][1]);
  }
  const auto ball = [](const Vec3& p) { return p.norm() < 1; };
  expect_solid(voxelised(flipped, 60), ball);
  expect_solid(voxelised(shuffled(inverted(flipped), 2), 60), ball);
}

TEST(Inner, FillsABallThroughASmallHole) {
  TriangleMesh mesh = primitive::sphere(1, 48);
  const std::size_t closed = voxelised(mesh, 60).inner.count();
  mesh.triangles.erase(mesh.triangles.begin() + 1000, mesh.triangles.begin() + 1010);
  const std::size_t open = voxelised(mesh, 60).inner.count();
  EXPECT_GT(static_cast<double>(open), 0.97 * static_cast<double>(closed));
  EXPECT_LT(static_cast<double>(open), 1.01 * static_cast<double>(closed));
}

TEST(Inner, TakesACrackFarNarrowerThanAVoxelAsClosed) {
  // Every triangle with its own vertices, each off by a little.
  const TriangleMesh ball = primitive::sphere(1, 48);
  TriangleMesh cracked;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1e-7, 1e-7);
  for (const auto& triangle : ball.triangles) {
    const auto first = static_cast<std::uint32_t>(cracked.vertices.size());
    for (const std::uint32_t corner : triangle) {
      cracked.vertices.push_back(ball.vertices[corner] +
                                 Vec3(noise(random), noise(random), noise(random)));
    }
    cracked.triangles.push_back({first, first + 1, first + 2});
  }
  expect_solid(voxelised(cracked, 60), [](const Vec3& p) { return p.norm() < 1; });
}

TEST(Inner, MovesWithTheMeshByWholeVoxels) {
  TriangleMesh mesh = primitive::torus(20, 7, 24);
  for (Vec3& p : mesh.vertices) p = (p * 1024).array().round() / 1024;
  TriangleMesh open = mesh;
  open.triangles.resize(open.triangles.size() - 5);
  const Workspace workspace{Vec3::Zero(), 1, {64, 64, 64}};
  for (const TriangleMesh& m : {mesh, open}) {
    for (const InnerMethod method : filling) {
      Triples expected;
      for (const auto& [i, j, k] : triples(voxelised(m, workspace, method).inner)) {
        expected.insert({i - 100, j + 7, k + 65});
      }
      EXPECT_EQ(triples(voxelised(moved(m, {-100, 7, 65}), workspace, method).inner), expected);
    }
  }
}

TEST(Inner, DependsNeitherOnTheOrderOfTrianglesNorOnThreads) {
  const TriangleMesh closed = joined(primitive::torus(1, 0.4, 40), primitive::sphere(0.3));
  TriangleMesh open = closed;
  open.triangles.resize(open.triangles.size() - 9);
  for (const TriangleMesh& mesh : {closed, open}) {
    const Workspace workspace = grid_of(mesh, 80);
    for (const InnerMethod method : filling) {
      const Triples expected = triples(voxelised(mesh, workspace, method).inner);
      for (unsigned seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(seed);
        EXPECT_EQ(triples(voxelised(shuffled(mesh, seed), workspace, method).inner), expected);
      }
      for (const int threads : {1, 2}) {
        SCOPED_TRACE(threads);
        tbb::task_arena(threads).execute(
            [&] { EXPECT_EQ(triples(voxelised(mesh, workspace, method).inner), expected); });
      }
    }
  }
}

TEST(WindingNumber, CountsTheTimesASurfaceWrapsAPoint) {
  const TriangleMesh box = primitive::box({2, 2, 2});
  const Vec3 inside(0.3, -0.2, 0.9), outside(1.5, 0, 0);
  EXPECT_NEAR(winding_number(box, inside), 1, 1e-12);
  EXPECT_NEAR(winding_number(box, outside), 0, 1e-12);
  EXPECT_NEAR(winding_number(inverted(box), inside), -1, 1e-12);
  EXPECT_NEAR(winding_number(joined(box, box), inside), 2, 1e-12);
  EXPECT_NEAR(winding_number(joined(box, inverted(box)), inside), 0, 1e-12);
}

TEST(WindingNumber, IsTheSolidAngleOfAnOpenSurface) {
  TriangleMesh lidless = primitive::box({2, 2, 2});
  std::erase_if(lidless.triangles, [&](const auto& triangle) {
    return std::ranges::all_of(triangle, [&](auto v) { return lidless.vertices[v].z() > 0; });
  });
  ASSERT_EQ(lidless.triangles.size(), 10u);
  // Each face of a cube takes up a sixth of the view from its centre.
  EXPECT_NEAR(winding_number(lidless, Vec3::Zero()), 5.0 / 6, 1e-12);
}

TEST(WindingNumber, CountsATriangleUnderThePointAsZero) {
  const TriangleMesh triangle{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(winding_number(triangle, {1, 1, 0}), 0);
}

class CleanMesh : public testing::TestWithParam<const char*> {};

TEST_P(CleanMesh, IsInnerWhereItsWindingNumberSaysSo) {
  const char* data = std::getenv("VICINITY_DATA");
  if (data == nullptr) GTEST_SKIP() << "VICINITY_DATA does not name the folder of real meshes";
  const TriangleMesh mesh = read_mesh(std::filesystem::path(data) / "meshes/clean" / GetParam());
  const Voxelised v = voxelised(mesh, 80);
  std::mt19937 random(11);
  std::size_t wrong = 0, inner = 0;
  // Some voxels only: the plain sum takes a good part of a millisecond.
  std::uniform_int_distribution<std::size_t> skip(
      0, std::max<std::size_t>(1, v.boundary.count() / test::rounds(200)));
  std::size_t left = 0;
  visit(v.boundary.box(), [&](const VoxelIndex& index) {
    if (v.boundary.contains(index) || left-- > 0) return;
    left = skip(random);
    const double size = std::abs(winding_number(mesh, v.workspace.centre_of(index)));
    ASSERT_NEAR(size, std::round(size), 1e-6);
    wrong += v.inner.contains(index) != (size > 0.5);
    inner += size > 0.5;
  });
  EXPECT_EQ(wrong, 0u);
  // And by even-odd, which is another route again.
  EXPECT_EQ(triples(inner_voxels(mesh, v.boundary, v.workspace, InnerMethod::raster)),
            triples(v.inner));
}

INSTANTIATE_TEST_SUITE_P(Inner, CleanMesh,
                         testing::Values("004_sugar_box_textured.obj", "1002_tray_bottom.STL",
                                         "F4.stl", "Plato.stl", "complex_bin.stl"));

struct Broken {
  const char* file;
  double least, most;  // of the boundary's box, the part that is inner
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.file; }

class BrokenMesh : public testing::TestWithParam<Broken> {};

TEST_P(BrokenMesh, IsFilledAsAPersonWouldExpect) {
  const char* data = std::getenv("VICINITY_DATA");
  if (data == nullptr) GTEST_SKIP() << "VICINITY_DATA does not name the folder of real meshes";
  const TriangleMesh mesh =
      read_mesh(std::filesystem::path(data) / "meshes/broken" / GetParam().file);
  const Voxelised v = voxelised(mesh, 64);
  const VoxelBox& box = v.boundary.box();
  const double part = static_cast<double>(v.inner.count()) / (box.hi.i - box.lo.i) /
                      (box.hi.j - box.lo.j) / (box.hi.k - box.lo.k);
  EXPECT_GE(part, GetParam().least);
  EXPECT_LE(part, GetParam().most);
}

INSTANTIATE_TEST_SUITE_P(
    Inner, BrokenMesh,
    testing::Values(Broken{"featuretype.STL", 0.3, 0.7}, Broken{"angle_block.STL", 0.3, 0.7},
                    Broken{"sphereWithHole.stl", 0.4, 0.53}, Broken{"soup.stl", 0, 0.4},
                    Broken{"LRO_35.stl", 0.001, 0.2}, Broken{"Spider_binary.stl", 0.001, 0.2},
                    Broken{"multibody.stl", 0.01, 0.1},
                    Broken{"openscad-nonmanifold-crash.obj", 0.001, 1},
                    Broken{"numpy-stl_ascii_Cube.stl", 0.9, 1}));

}  // namespace
}  // namespace vicinity
