// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/layers/distance_layers.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "layers/nearest_triangle.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/inner.h"

namespace vicinity {
namespace {

/// How far a computed distance may be from the oracle's, in voxels.
constexpr double tolerance = 4e-6;

struct Voxelised {
  TriangleMesh mesh;
  Workspace workspace;
  VoxelSet boundary, inner;
};

Voxelised voxelise(TriangleMesh mesh, double voxel_size, InnerMethod method) {
  Workspace workspace;
  workspace.origin = mesh.bounds().min() - Vec3(0.31, 0.47, 0.23) * voxel_size;
  workspace.voxel_size = voxel_size;
  VoxelSet boundary = boundary_voxels(mesh, workspace);
  VoxelSet inner = inner_voxels(mesh, boundary, workspace, method);
  return {std::move(mesh), workspace, std::move(boundary), std::move(inner)};
}

/// The stored distance of a voxel in steps, or -1 where no block is stored.
int stored_steps(const DistanceLayers& layers, const VoxelIndex& v) {
  const DistanceBlock* block = layers.distances.find(block_of(v));
  if (block == nullptr) return -1;
  return block->steps[BitBlock::row(v.j, v.k) * 64 + static_cast<std::size_t>(v.i & 63)];
}

/// Rank 1..q of a voxel, 0 for none; -1 for two at once.
int rank_of(const RankedNeighbours& layers, const VoxelIndex& v) {
  int rank = 0;
  for (std::size_t n = 0; n < layers.ranks.size(); ++n) {
    if (layers.ranks[n].contains(v)) rank = rank == 0 ? static_cast<int>(n) + 1 : -1;
  }
  return rank;
}

/// Rank and stored distance of every voxel of a box against the oracle.
void expect_true_distances(const DistanceLayers& layers, const Voxelised& object, int m, int q,
                           const VoxelBox& box) {
  ASSERT_EQ(layers.neighbours.ranks.size(), static_cast<std::size_t>(q));
  const TriangleTree tree(object.mesh);
  int complaints = 0;
  for (int k = box.lo.k; k < box.hi.k && complaints < 10; ++k) {
    for (int j = box.lo.j; j < box.hi.j; ++j) {
      for (int i = box.lo.i; i < box.hi.i; ++i) {
        const VoxelIndex v{i, j, k};
        const int rank = rank_of(layers.neighbours, v);
        if (object.inner.contains(v)) {
          if (rank != 0) ++complaints, ADD_FAILURE() << "inner voxel with rank " << rank;
          continue;
        }
        const double h = object.workspace.voxel_size;
        const double distance =
            tree.distance(object.workspace.centre_of(v), (q * m + 2) * h) / h;  // or beyond all
        const bool skin = object.boundary.contains(v);
        const auto rank_at = [&](double d) {
          const int n = static_cast<int>(std::max(0.0, d - half_diagonal_vox) / m) + 1;
          return skin || n > q ? 0 : n;
        };
        if (rank != rank_at(distance - tolerance) && rank != rank_at(distance + tolerance)) {
          ++complaints;
          ADD_FAILURE() << "rank " << rank << " at distance " << distance << ", voxel " << i << ' '
                        << j << ' ' << k;
        }
        if (!skin && rank == 0) continue;
        const double stored = stored_steps(layers, v) * distance_step_vox;
        if (stored > distance + tolerance || stored + distance_step_vox < distance - tolerance) {
          ++complaints;
          ADD_FAILURE() << "stored " << stored << " at distance " << distance << ", voxel " << i
                        << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

/// The same of the layers' box, and around it.
void expect_true_distances(const Voxelised& object, int m, int q) {
  expect_true_distances(
      distance_layers(object.mesh, object.boundary, object.inner, object.workspace, m, q), object,
      m, q, object.boundary.box().grown(q * m + 3));
}

TEST(DistanceOracle, TreeFindsWhatAskingEveryTriangleFinds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const TriangleMesh mesh = primitive::torus(0.5, 0.2, 16);
  const TriangleTree tree(mesh);
  for (int n = 0; n < 500; ++n) {
    const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
    EXPECT_DOUBLE_EQ(tree.distance(p), distance_to_mesh(mesh, p));
  }
}

TEST(DistanceLayers, AreTrueAroundABox) {
  expect_true_distances(voxelise(primitive::box({0.3, 0.2, 0.1}), 0.01, InnerMethod::winding), 3,
                        3);
}

TEST(DistanceLayers, AreTrueAroundASphere) {
  expect_true_distances(voxelise(primitive::sphere(0.2, 24), 0.01, InnerMethod::winding), 4, 3);
}

TEST(DistanceLayers, AreTrueAroundConcaveSolids) {
  expect_true_distances(voxelise(primitive::torus(0.2, 0.08, 20), 0.01, InnerMethod::winding), 4,
                        2);
  expect_true_distances(
      voxelise(primitive::v_block({0.3, 0.2, 0.2}, 0.15), 0.01, InnerMethod::none), 4, 2);
}

/// A soup of random triangles: ordinary ones, slivers, needles, and some without area; some share
/// vertices, so that edges of one, two and more faces occur.
TriangleMesh soup(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(0, 20);
  std::uniform_real_distribution<double> unit(0, 1);
  TriangleMesh mesh;
  const auto vertex = [&](const Vec3& p) {
    mesh.vertices.push_back(p);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  const auto anywhere = [&] {
    return vertex({coordinate(random), coordinate(random), coordinate(random)});
  };
  for (int n = 0; n < 14; ++n) {
    const std::uint32_t a = n > 0 && unit(random) < 0.6
                                ? mesh.triangles.back()[static_cast<std::size_t>(n % 3)]
                                : anywhere();
    const std::uint32_t b = n > 0 && unit(random) < 0.6
                                ? mesh.triangles[static_cast<std::size_t>(n / 2)][1]
                                : anywhere();
    const Vec3 p = mesh.vertices[a], q = mesh.vertices[b];
    const double kind = unit(random);
    if (kind < 0.5) {
      mesh.triangles.push_back({a, b, anywhere()});
    } else if (kind < 0.8) {  // a sliver, from the thickness of rounding up to a tenth of a voxel
      const double thickness = std::pow(10, -16 + 15 * unit(random));
      const Vec3 off = thickness * Vec3(unit(random), unit(random), unit(random));
      mesh.triangles.push_back({a, b, vertex(p + unit(random) * (q - p) + off)});
    } else if (kind < 0.9) {  // a needle
      mesh.triangles.push_back({a, b, vertex(q + 1e-5 * Vec3(unit(random), unit(random), 0))});
    } else {  // no area at all
      mesh.triangles.push_back({a, b, b});
    }
  }
  return mesh;
}

TEST(DistanceLayers, AreTrueAroundSoupWithSliversAndDegenerateTriangles) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    expect_true_distances(voxelise(soup(random), 1.0, InnerMethod::none), 3, 2);
    if (testing::Test::HasFailure()) break;
  }
}

TEST(DistanceLayers, AreTrueAroundARoughScanWithTrianglesSmallerThanVoxels) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> off(-0.4, 0.4);
    TriangleMesh scan = primitive::sphere(6, 64);
    for (Vec3& p : scan.vertices) p += Vec3(off(random), off(random), off(random));
    expect_true_distances(voxelise(std::move(scan), 1.0, InnerMethod::none), 3, 3);
  }
}

TEST(DistanceLayers, AreTrueFarAlongTrianglesOfThousandsOfVoxels) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> near(-12, 12), far(-4000, 4000);
    Voxelised object;
    object.workspace.voxel_size = 1;
    for (int n = 0; n < 4; ++n) {
      // Through the box's middle, from one end far away to the other; some are slivers.
      const Vec3 p(near(random), near(random), near(random)),
          d(far(random), far(random), far(random));
      const Vec3 wide = n == 0 ? 0.01 * Vec3(near(random), near(random), near(random))
                               : Vec3(far(random), far(random), far(random));
      const auto first = static_cast<std::uint32_t>(object.mesh.vertices.size());
      object.mesh.vertices.insert(object.mesh.vertices.end(), {p - d, p + d, p + d + wide});
      object.mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const VoxelBox box{{-13, -9, -11}, {10, 12, 9}};
    const SurfaceDistances distances(object.mesh, object.workspace, 3, 3);
    expect_true_distances(distances.layers(VoxelSet(), VoxelSet(), box), object, 3, 3, box);
    if (testing::Test::HasFailure()) break;
  }
}

TEST(DistanceLayers, AreTrueBeyondTheTipsOfNeedles) {
  // Centres lie in line with the needle: a little in front of its sides is far from its tip.
  const VoxelBox box{{0, 0, 0}, {20, 16, 16}};
  for (const double half_width : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      SCOPED_TRACE(std::to_string(half_width) + " along axis " + std::to_string(axis));
      Voxelised object;
      object.workspace.voxel_size = 1;
      for (const double off : {-half_width, half_width}) {
        Vec3 p(8.5, 8.5, 8.5);
        p[axis] = 2.25;
        p[(axis + 1) % 3] += off;
        object.mesh.vertices.push_back(p);
      }
      Vec3 tip(8.5, 8.5, 8.5);
      tip[axis] = 9.3;
      object.mesh.vertices.push_back(tip);
      object.mesh.triangles.push_back({0, 1, 2});
      const SurfaceDistances distances(object.mesh, object.workspace, 2, 4);
      expect_true_distances(distances.layers(VoxelSet(), VoxelSet(), box), object, 2, 4, box);
    }
  }
}

TEST(DistanceLayers, RoundDownDistancesThatAreWholeSteps) {
  // Everything is a whole number of steps, so that whole numbers tell what is right to the last
  // bit.
  const std::int64_t per_voxel = 128;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::int64_t> low(20 * per_voxel, 22 * per_voxel),
        size(1, 9 * per_voxel);
    std::array<std::int64_t, 3> lo, hi;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = low(random);
      hi[axis] = lo[axis] + size(random);
      // Planes through centres, and a whole number of voxels away from them, are common.
      if (seed % 2 == 0) lo[axis] -= lo[axis] % 64, hi[axis] += 64 - hi[axis] % 64;
    }
    const auto in_voxels = [per_voxel](const std::array<std::int64_t, 3>& steps) -> Vec3 {
      return Vec3(static_cast<double>(steps[0]), static_cast<double>(steps[1]),
                  static_cast<double>(steps[2])) /
             static_cast<double>(per_voxel);
    };
    const Vec3 from = in_voxels(lo), to = in_voxels(hi);
    Voxelised object;
    object.workspace.voxel_size = 1;
    object.mesh = primitive::box(to - from);
    const Vec3 move = from - object.mesh.bounds().min();
    for (Vec3& p : object.mesh.vertices) p += move;
    ASSERT_EQ(object.mesh.bounds().max(), to);
    const int m = 2, q = 4;
    const SurfaceDistances distances(object.mesh, object.workspace, m, q);
    const VoxelBox box{{8, 8, 8}, {44, 44, 44}};
    const DistanceLayers layers = distances.layers(VoxelSet(), VoxelSet(), box);
    int wrong = 0;
    for (int k = box.lo.k; k < box.hi.k; ++k) {
      for (int j = box.lo.j; j < box.hi.j; ++j) {
        for (int i = box.lo.i; i < box.hi.i; ++i) {
          std::int64_t squared = 0, inside = std::numeric_limits<std::int64_t>::max();
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t p = (std::array{i, j, k}[axis]) * per_voxel + per_voxel / 2;
            const std::int64_t away = std::max({lo[axis] - p, p - hi[axis], std::int64_t{0}});
            squared += away * away;
            inside = std::min({inside, p - lo[axis], hi[axis] - p});
          }
          if (squared == 0) squared = inside * inside;
          auto steps = static_cast<std::int64_t>(std::sqrt(static_cast<double>(squared)));
          while (steps * steps > squared) --steps;
          while ((steps + 1) * (steps + 1) <= squared) ++steps;
          if (rank_of(layers.neighbours, {i, j, k}) == 0) continue;
          if (stored_steps(layers, {i, j, k}) != steps) ++wrong;
        }
      }
    }
    EXPECT_EQ(wrong, 0);
  }
}

TEST(DistanceLayers, AreTrueAroundAThinPlate) {
  expect_true_distances(voxelise(primitive::box({0.2, 0.15, 0.0004}), 0.01, InnerMethod::winding),
                        2, 4);
}

TEST(DistanceLayers, AreTrueAroundAnOpenSheet) {
  TriangleMesh sheet;  // a folded sheet with a free edge all around
  sheet.vertices = {{0, 0, 0}, {0.1, 0, 0.03}, {0.1, 0.1, 0.02}, {0, 0.1, 0.05}, {0.2, 0.04, 0.1}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
  expect_true_distances(voxelise(sheet, 0.01, InnerMethod::none), 3, 3);
}

TEST(DistanceLayers, AreTrueAroundVerticesOfManyEdges) {
  expect_true_distances(voxelise(primitive::cone(0.1, 0.2, 48), 0.01, InnerMethod::winding), 3, 3);
}

TEST(DistanceLayers, WithoutRanksKeepTheDistancesOfTheSkin) {
  const Voxelised object = voxelise(primitive::sphere(0.1, 16), 0.01, InnerMethod::winding);
  expect_true_distances(object, 4, 0);
}

/// A mesh file of the project's data, 32 voxels long; nothing where there is none.
std::optional<Voxelised> clean_mesh(const char* name) {
  const char* const data = std::getenv("VICINITY_DATA");
  if (data == nullptr) return std::nullopt;
  TriangleMesh mesh = read_mesh(std::filesystem::path(data) / "meshes" / "clean" / name);
  const double voxel_size = mesh.bounds().sizes().maxCoeff() / 32;
  return voxelise(std::move(mesh), voxel_size, InnerMethod::winding);
}

class CleanMesh : public testing::TestWithParam<const char*> {};

TEST_P(CleanMesh, HasTrueDistancesInEveryVoxel) {
  const auto object = clean_mesh(GetParam());
  if (!object) GTEST_SKIP() << "VICINITY_DATA does not name the folder of meshes.";
  expect_true_distances(*object, 4, 3);
}

/// Least distance from the surface to the corners and to some points of a voxel, in voxels.
double least_distance(const TriangleTree& tree, const Workspace& workspace, const VoxelIndex& v,
                      std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 12; ++n) {
    const Vec3 in_voxel =
        n < 8 ? Vec3(n & 1, (n >> 1) & 1, n >> 2) : Vec3(unit(random), unit(random), unit(random));
    const Vec3 p = workspace.origin + workspace.voxel_size * (Vec3(v.i, v.j, v.k) + in_voxel);
    least = tree.distance(p, least);
  }
  return least / workspace.voxel_size;
}

/// No point of any voxel of rank n is nearer than (n-1)*m voxels, less the bound; and some point
/// comes within a voxel of being so: the bound is no wider than it must be.
void expect_true_and_tight(const Voxelised& object, const RankedNeighbours& layers, int m,
                           double bound) {
  const TriangleTree tree(object.mesh);
  std::mt19937 random(5);
  double tightest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < layers.ranks.size(); ++n) {
    const double promised = static_cast<double>(n) * m - bound;
    int optimistic = 0;
    layers.ranks[n].for_each([&](const VoxelIndex& v) {
      // Where the centre is far enough for all of the voxel, its points need not be asked.
      const double far = (promised + 0.5 + half_diagonal_vox) * object.workspace.voxel_size;
      if (tree.distance(object.workspace.centre_of(v), far) >= far) return;
      const double least = least_distance(tree, object.workspace, v, random);
      if (least < promised - tolerance) ++optimistic;
      if (promised > 0) tightest = std::min(tightest, least - promised);
    });
    EXPECT_EQ(optimistic, 0) << "rank " << n + 1;
  }
  EXPECT_LT(tightest, 1);
}

TEST_P(CleanMesh, IsNeverNearerThanItsRanksSay) {
  const auto object = clean_mesh(GetParam());
  if (!object) GTEST_SKIP() << "VICINITY_DATA does not name the folder of meshes.";
  const int m = 3, q = 3;
  expect_true_and_tight(
      *object,
      distance_layers(object->mesh, object->boundary, object->inner, object->workspace, m, q)
          .neighbours,
      m, 0);
  for (const LayerShape shape : {LayerShape::cube, LayerShape::sphere}) {
    SCOPED_TRACE(to_string(shape));
    expect_true_and_tight(
        *object, ranked_neighbours(object->boundary, object->inner, ShapingElement(shape, m), q), m,
        rank_bound_vox(shape, m, q));
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheProject, CleanMesh,
                         testing::Values("Plato.stl", "complex_bin.stl", "F4.stl"),
                         [](const auto& name) {
                           const std::string file = name.param;
                           return file.substr(0, file.find('.'));
                         });

/// Whether two results are the same in every voxel, the second moved by `shift`.
bool same_layers(const DistanceLayers& a, const DistanceLayers& b, const VoxelIndex& shift) {
  bool same = a.neighbours.ranks.size() == b.neighbours.ranks.size();
  for (std::size_t n = 0; same && n < a.neighbours.ranks.size(); ++n) {
    const VoxelSet &rank = a.neighbours.ranks[n], &other = b.neighbours.ranks[n];
    same = rank.count() == other.count();
    rank.for_each([&](const VoxelIndex& v) {
      const VoxelIndex w{v.i + shift.i, v.j + shift.j, v.k + shift.k};
      same = same && other.contains(w) && stored_steps(a, v) == stored_steps(b, w);
    });
  }
  return same;
}

DistanceLayers layers_of(const Voxelised& object) {
  return distance_layers(object.mesh, object.boundary, object.inner, object.workspace, 4, 4);
}

/// Whether two results have the same blocks, to the last bit, skin and free voxels included.
bool identical(const DistanceLayers& a, const DistanceLayers& b) {
  bool same = a.distances.block_count() == b.distances.block_count();
  a.distances.for_each([&](const BlockIndex& index, const DistanceBlock& block) {
    const DistanceBlock* other = b.distances.find(index);
    same = same && other != nullptr && block.steps == other->steps;
  });
  return same && same_layers(a, b, {0, 0, 0});
}

TEST(DistanceLayers, DoNotDependOnTheNumberOfThreads) {
  std::vector<Voxelised> objects;
  objects.push_back(voxelise(primitive::torus(0.3, 0.1, 32), 0.01, InnerMethod::winding));
  for (unsigned seed = 50; seed < 55; ++seed) {
    std::mt19937 random(seed);
    objects.push_back(voxelise(soup(random), 0.5, InnerMethod::none));
  }
  for (const Voxelised& object : objects) {
    std::vector<DistanceLayers> layers;
    for (const std::size_t threads : {1u, 2u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      layers.push_back(layers_of(object));
    }
    EXPECT_TRUE(identical(layers[0], layers[1]));
  }
}

TEST(DistanceLayers, InPartsAreWhatTheyAreAsAWhole) {
  const Voxelised object = voxelise(primitive::torus(0.3, 0.1, 32), 0.01, InnerMethod::winding);
  const DistanceLayers whole = layers_of(object);
  const SurfaceDistances distances(object.mesh, object.workspace, 4, 4);
  const VoxelBox box = distances.box(object.boundary.box());
  ASSERT_EQ(box, whole.distances.box());
  std::size_t ranked = 0, wrong = 0;
  for (std::int32_t k = box.lo.k; k < box.hi.k; k += 13) {  // across slabs
    VoxelBox part = box;
    part.lo.k = k;
    part.hi.k = std::min(k + 13, box.hi.k);
    const DistanceLayers layers = distances.layers(object.boundary, object.inner, part);
    for (std::size_t n = 0; n < 4; ++n) {
      layers.neighbours.ranks[n].for_each([&](const VoxelIndex& v) {
        ++ranked;
        wrong += !part.contains(v) || !whole.neighbours.ranks[n].contains(v) ||
                 stored_steps(layers, v) != stored_steps(whole, v);
      });
    }
    object.boundary.for_each([&](const VoxelIndex& v) {
      if (part.contains(v)) wrong += stored_steps(layers, v) != stored_steps(whole, v);
    });
  }
  std::size_t ranked_as_a_whole = 0;
  for (const VoxelSet& rank : whole.neighbours.ranks) ranked_as_a_whole += rank.count();
  EXPECT_EQ(ranked, ranked_as_a_whole);
  EXPECT_EQ(wrong, 0u);
}

TEST(DistanceLayers, DoNotDependOnTheOrderOfTrianglesOrVertices) {
  Voxelised object = voxelise(primitive::torus(0.3, 0.1, 32), 0.01, InnerMethod::winding);
  const DistanceLayers layers = layers_of(object);
  std::mt19937 random(1);
  TriangleMesh& mesh = object.mesh;
  std::vector<std::uint32_t> place(mesh.vertices.size());
  std::iota(place.begin(), place.end(), 0u);
  std::shuffle(place.begin(), place.end(), random);
  std::vector<Vec3> vertices(place.size());
  for (std::size_t v = 0; v < place.size(); ++v) vertices[place[v]] = mesh.vertices[v];
  mesh.vertices = vertices;
  for (auto& [a, b, c] : mesh.triangles) {
    const auto [first, second, third] = std::tuple(place[a], place[b], place[c]);
    a = third, b = second, c = first;
  }
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  EXPECT_TRUE(same_layers(layers, layers_of(object), {0, 0, 0}));
}

TEST(DistanceLayers, MoveWithTheObject) {
  // A power of two, so that the moved mesh is the same to the last bit.
  const double h = 1.0 / 128;
  TriangleMesh mesh = primitive::box({20.5 * h, 17 * h, 11.25 * h});
  for (Vec3& p : mesh.vertices) p += h * Vec3(30.25, 9.5, 8);
  const auto voxelised = [&](TriangleMesh placed) {
    Workspace workspace;
    workspace.voxel_size = h;
    VoxelSet boundary = boundary_voxels(placed, workspace);
    VoxelSet inner = inner_voxels(placed, boundary, workspace);
    return Voxelised{std::move(placed), workspace, std::move(boundary), std::move(inner)};
  };
  const DistanceLayers layers = layers_of(voxelised(mesh));
  for (Vec3& p : mesh.vertices) p += h * Vec3(-70, 5, 19);
  EXPECT_TRUE(same_layers(layers, layers_of(voxelised(mesh)), {-70, 5, 19}));
}

TEST(DistanceLayers, OfNothingAreEmpty) {
  const DistanceLayers layers = distance_layers({}, VoxelSet(), VoxelSet(), {}, 4, 3);
  ASSERT_EQ(layers.neighbours.ranks.size(), 3u);
  for (const VoxelSet& rank : layers.neighbours.ranks) EXPECT_EQ(rank.count(), 0u);
  EXPECT_EQ(layers.distances.block_count(), 0u);
}

TEST(DistanceLayers, RefuseNumbersOutOfRange) {
  EXPECT_THROW(distance_layers({}, VoxelSet(), VoxelSet(), {}, 0, 3), Error);
  EXPECT_THROW(distance_layers({}, VoxelSet(), VoxelSet(), {}, 9, 3), Error);
  EXPECT_THROW(distance_layers({}, VoxelSet(), VoxelSet(), {}, 4, -1), Error);
  EXPECT_THROW(distance_layers({}, VoxelSet(), VoxelSet(), {}, 4, 33), Error);
}

}  // namespace
}  // namespace vicinity
