// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Verdicts on layers: turned by ranks that are off by one, and by a mask that is ignored.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bench_room.h"
#include "reproduce/layers.h"
#include "reproduce/parts.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity::report {
namespace {

Part round(double radius) {
  TriangleMesh mesh = primitive::sphere(radius, 64);
  for (Vec3& p : mesh.vertices) p += Vec3::Constant(32);
  return {"round", mesh, {64, 64, 64}};
}

TEST(RankFit, TurnsForRanksThatAreOffByOne) {
  const BenchRoom room;
  const ViscosityField distances = room.workshop().distances(round(8), 24);
  for (const LayerShape shape : {LayerShape::cube, LayerShape::sphere}) {
    for (const int m : {1, 2, 3}) {
      SCOPED_TRACE(std::string(to_string(shape)) + ", m = " + std::to_string(m));
      const Layers layers{.m = m, .q = 4, .shape = shape};
      const auto fits = [&](double radius) {
        const ViscosityField field = room.workshop().field(round(radius), layers);
        return ranks_follow_distance({rank_fit("round", field, distances, m)});
      };
      EXPECT_TRUE(fits(8).holds) << fits(8).measured;
      EXPECT_FALSE(fits(8 + m).holds) << "every rank one too low: " << fits(8 + m).measured;
      EXPECT_FALSE(fits(8 - m).holds) << "every rank one too high: " << fits(8 - m).measured;
    }
  }
}

TEST(RankFit, TurnsForAWrongM) {
  const BenchRoom room;
  const ViscosityField distances = room.workshop().distances(round(8), 24);
  const ViscosityField field = room.workshop().field(round(8), {.m = 2, .q = 4});
  EXPECT_FALSE(ranks_follow_distance({rank_fit("round", field, distances, 3)}).holds);
}

// The plain loop of the paper, counting as it goes.
TEST(Visits, OfThePlainLoopAreThoseOfThePlainLoop) {
  const BenchRoom room;
  const int m = 2, q = 3;
  const ViscosityField field = room.workshop().field(round(6), {.m = m, .q = q});
  const VoxelIndex& dims = field.workspace().dims;
  const auto rank_at = [&](int i, int j, int k) {
    const VoxelRecord record = field.records()[field.code_at({i, j, k})];
    return record.kind == VoxelKind::empty   ? q + 1
           : record.kind == VoxelKind::inner ? -1
                                             : record.rank;
  };
  std::vector<bool> taken(static_cast<std::size_t>(dims.i * dims.j * dims.k));
  Visits counted;
  for (int n = 1; n <= q; ++n) {
    for (int k = 0; k < dims.k; ++k) {
      for (int j = 0; j < dims.j; ++j) {
        for (int i = 0; i < dims.i; ++i) {
          if (rank_at(i, j, k) != n - 1) continue;
          for (int d = 0; d < 125; ++d) {
            const int x = d % 5 - 2, y = d / 5 % 5 - 2, z = d / 25 - 2;
            if (x * x + y * y + z * z > m * m) continue;
            ++counted.cells;
            const auto at =
                static_cast<std::size_t>((i + x) + dims.i * ((j + y) + dims.j * (k + z)));
            if (rank_at(i + x, j + y, k + z) != n || taken[at]) continue;
            taken[at] = true;
            ++counted.changed;
          }
        }
      }
    }
  }
  const Visits stated = visits_of_plain_loop(field);
  EXPECT_EQ(stated.cells, counted.cells);
  EXPECT_EQ(stated.changed, counted.changed);
  EXPECT_LT(visits_of_frontier(field).cells, counted.cells);
}

TEST(Concavities, AreFoundAsTheyWereDrawn) {
  const BenchRoom room;
  const ViscosityField field = room.workshop().field(complex_cylinder(), {.m = 2, .q = 3});
  const std::vector<Concavity> found =
      concavities(field, complex_cylinder_x, complex_cylinder_y, 40, complex_cylinder_radius);
  ASSERT_EQ(found.size(), 5u);
  EXPECT_LT(found[0].mouth, found[1].mouth / 2);
  EXPECT_GT(found[0].depth, found[0].mouth);
  for (std::size_t n = 1; n < found.size(); ++n) EXPECT_LT(found[n].depth, found[n].mouth);
}

std::vector<LayerReach> reaches(double least, double most) {
  return {{1, 1.9, 2, 2.1}, {2, 0, 0, 0}, {3, 0, 0, 0},
          {4, 0, 0, 0},     {5, 0, 0, 0}, {6, least, (least + most) / 2, most}};
}

TEST(Fig17To19, TurnWhereTheMaskIsIgnored) {
  const Wrapping cube{"part", LayerShape::cube, 2, reaches(12, 20)};
  const Wrapping sphere{"part", LayerShape::sphere, 2, reaches(11, 12)};
  const Wrapping large{"part", LayerShape::sphere, 3, reaches(17.5, 18)};
  const Wrapping large_cube{"part", LayerShape::cube, 3, reaches(18, 30)};
  const std::vector<Concavity> concavities{{.mouth = 7, .depth = 10, .dip_by_rank = {10, 6, 3, 1}},
                                           {.mouth = 20, .depth = 8, .dip_by_rank = {8, 8, 8, 7}}};
  EXPECT_TRUE(agrees(check_fig17({cube})));
  EXPECT_FALSE(agrees(check_fig17({sphere})));
  EXPECT_TRUE(agrees(check_fig18({cube, sphere}, concavities)));
  EXPECT_FALSE(agrees(check_fig18({cube, cube}, concavities)));
  EXPECT_FALSE(agrees(check_fig18({cube, sphere}, {concavities[1], concavities[1]})));
  EXPECT_TRUE(agrees(check_fig19({sphere, large}, 0, 10)));
  EXPECT_FALSE(agrees(check_fig19({cube, large_cube}, 0, 10)));
  EXPECT_FALSE(agrees(check_fig19({sphere, large}, 1, 10)));
}

TEST(Fig16, TurnsForANeighbourTooFewOrTooMany) {
  EXPECT_TRUE(agrees(check_fig16({.ranked = 9, .missing = 0, .beyond = 0})));
  EXPECT_FALSE(agrees(check_fig16({.ranked = 9, .missing = 1, .beyond = 0})));
  EXPECT_FALSE(agrees(check_fig16({.ranked = 9, .missing = 0, .beyond = 1})));
}

// A table that says what the paper says, and one in which the mask does nothing.
TEST(Table1, AgreesWithTheWordsOfThePaperAndTurnsWhereTheMaskIsIgnored) {
  std::vector<ElementPerformance> rows;
  for (const LayerShape shape : {LayerShape::cube, LayerShape::sphere}) {
    for (const int m : {1, 2, 3}) {
      const bool cube = shape == LayerShape::cube;
      const double reach = 6 * m;
      const std::uint64_t changed = 1000;
      rows.push_back(
          {.shape = shape,
           .m = m,
           .cells = 0,
           .last = {6, reach, reach, reach},
           .axis = reach,
           .face_diagonal = reach * (cube ? 1.4 : 1),
           .space_diagonal = reach * (cube ? 1.7 : 1 - 0.3 / m),
           .plain = {changed * static_cast<std::uint64_t>(cube ? 9 + m : 9 - m), changed},
           .ours = {changed * 2, changed}});
    }
  }
  EXPECT_TRUE(agrees(check_table1(rows))) << why(check_table1(rows));
  std::vector<ElementPerformance> ignored = rows;
  for (std::size_t n = 0; n < 3; ++n) {
    ignored[n + 3] = rows[n];
    ignored[n + 3].shape = LayerShape::sphere;
  }
  EXPECT_FALSE(agrees(check_table1(ignored)));
}

TEST(Fig20, TurnsWhereSectionsDoNotShrinkOrAreNotRound) {
  const auto ring = [](int m, int z, double radius) {
    return ConeSection{m, z, std::vector<double>(360, radius)};
  };
  std::vector<ConeSection> sections{ring(2, 20, 30), ring(2, 40, 20), ring(4, 20, 40),
                                    ring(4, 40, 30)};
  EXPECT_TRUE(agrees(check_fig20(sections)));
  sections[0].radii[45] = 36;
  EXPECT_FALSE(agrees(check_fig20(sections)));
  sections[0] = ring(2, 20, 15);
  EXPECT_FALSE(agrees(check_fig20(sections)));
}

TEST(Fig21, TurnsForAMissingLayerAndForALopsidedV) {
  const std::vector<std::uint64_t> seven(7, 1000);
  EXPECT_TRUE(agrees(check_fig21(seven, 0)));
  EXPECT_FALSE(agrees(check_fig21(seven, 700)));
  EXPECT_FALSE(agrees(check_fig21({1000, 1000, 0, 1000, 1000, 1000, 1000}, 0)));
  EXPECT_FALSE(agrees(check_fig21({1000, 1000, 1000, 1000, 1000, 1000}, 0)));
}

}  // namespace
}  // namespace vicinity::report
