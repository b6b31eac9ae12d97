// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Shells, held against every face of every voxel, looked at one by one.

#include "show/shells.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

#include "vicinity/mesh/primitive.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity::viewer {
namespace {

// A face: cell and the way it looks.
using Face = std::tuple<int, int, int, int>;
// How often a face is covered, and whose it is.
using Faces = std::map<Face, std::pair<int, int>>;

ViscosityField random_field(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(random() % 1000) / 1000;
  };
  Scene scene;
  scene.voxel_size = 0.01;
  for (const char* name : {"a", "b", "c"}) {
    SceneObject object;
    object.name = name;
    object.shape =
        random() % 2 == 0
            ? primitive::box({between(0.02, 0.5), between(0.02, 0.2), between(0.004, 0.1)})
            : primitive::sphere(between(0.02, 0.12), 16);
    object.X_WO.translation() = Vec3(between(0, 0.4), between(0, 0.4), between(0, 0.2));
    object.m = 1 + static_cast<int>(random() % 3);
    object.q = static_cast<int>(random() % 4);
    scene.objects.push_back(object);
  }
  return build_field(scene, {.threads = 1, .progress = {}}).field;
}

// -1 skin, n rank n, 99 empty: of a cell, by its definition.
std::pair<int, int> cell(const ViscosityField& field, int step, int i, int j, int k) {
  const auto at = [&](int x, int y, int z) { return field.records()[field.code_at({x, y, z})]; };
  for (int z = k * step; z < (k + 1) * step; ++z) {
    for (int y = j * step; y < (j + 1) * step; ++y) {
      for (int x = i * step; x < (i + 1) * step; ++x) {
        const VoxelRecord record = at(x, y, z);
        if (record.kind >= VoxelKind::inner) return {0, record.object};
      }
    }
  }
  const int half = step / 2;
  const VoxelRecord record = at(i * step + half, j * step + half, k * step + half);
  return record.kind == VoxelKind::empty ? std::pair(99, 0)
                                         : std::pair<int, int>(record.rank, record.object);
}

Faces plain_faces(const ViscosityField& field, int step, int rank) {
  Faces faces;
  const VoxelIndex dims = field.workspace().dims;
  const int way[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  for (int k = 0; k * step < dims.k; ++k) {
    for (int j = 0; j * step < dims.j; ++j) {
      for (int i = 0; i * step < dims.i; ++i) {
        const auto [level, object] = cell(field, step, i, j, k);
        if (level != rank) continue;
        for (int face = 0; face < 6; ++face) {
          const int* d = way[face];
          if (cell(field, step, i + d[0], j + d[1], k + d[2]).first > level) {
            faces[{i, j, k, face}] = {1, object};
          }
        }
      }
    }
  }
  return faces;
}

Faces covered_faces(const std::vector<Quad>& quads) {
  Faces faces;
  for (const Quad& quad : quads) {
    const int axis = quad.face / 2, first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    for (int b = 0; b < quad.b; ++b) {
      for (int a = 0; a < quad.a; ++a) {
        int at[3] = {quad.i, quad.j, quad.k};
        at[first] += a;
        at[second] += b;
        auto& [count, object] = faces[{at[0], at[1], at[2], quad.face}];
        ++count;
        object = quad.object;
      }
    }
  }
  return faces;
}

TEST(Shells, CoverEveryOuterFaceOfEveryLayerOnceAndNothingElse) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const ViscosityField field = random_field(seed);
    for (const int step : {1, 2, 4, 16}) {
      const Shells shells = shells_of(field, step);
      ASSERT_EQ(shells.step, step);
      for (std::size_t rank = 0; rank < shells.by_rank.size(); ++rank) {
        EXPECT_EQ(covered_faces(shells.by_rank[rank]),
                  plain_faces(field, step, static_cast<int>(rank)))
            << "seed " << seed << ", step " << step << ", rank " << rank;
      }
    }
  }
}

TEST(Shells, AFlatFaceIsAFewQuads) {
  Scene scene;
  scene.voxel_size = 0.01;
  SceneObject plate;
  plate.name = "plate";
  plate.shape = primitive::box({0.605, 0.605, 0.015});
  plate.q = 0;
  plate.coding.mu = {};
  scene.objects.push_back(plate);
  const ViscosityField field = build_field(scene, {.threads = 1, .progress = {}}).field;
  const Shells shells = shells_of(field, 1);
  ASSERT_EQ(shells.by_rank.size(), 1u);
  EXPECT_LE(shells.by_rank[0].size(), 6u);
}

}  // namespace
}  // namespace vicinity::viewer
