// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "random_scene.h"
#include "rounds.h"
#include "seeds.h"
#include "surface_distance.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

using test::for_each_seed;
using test::random_scene_voxel;
using test::real;
using test::surface_distance;
using test::whole;

constexpr double h = random_scene_voxel;

/// `objects` solids in `distance` mode with one coding.
Scene distance_scene(std::mt19937& random, int objects, int m, const Coding& coding) {
  Scene scene = test::random_scene(random, objects, 20);
  for (SceneObject& object : scene.objects) {
    object.layers = LayerShape::distance;
    object.inner = InnerMethod::winding;
    object.m = m;
    object.q = static_cast<int>(coding.mu.size());
    object.coding = coding;
  }
  return scene;
}

Vec3 random_point(std::mt19937& random, const ViscosityField& field) {
  const Workspace& w = field.workspace();
  return w.origin + w.voxel_size * Vec3(real(random, 0, w.dims.i), real(random, 0, w.dims.j),
                                        real(random, 0, w.dims.k));
}

double true_distance(const Scene& scene, const Vec3& p) {
  double least = 1e300;
  for (const SceneObject& object : scene.objects) {
    least = std::min(least, surface_distance(std::get<TriangleMesh>(object.shape), p));
  }
  return least;
}

bool in_skin(const FieldSample& sample) {
  return sample.record.kind == VoxelKind::boundary || sample.record.kind == VoxelKind::inner;
}

TEST(DistanceField, DistanceIsNeverMoreThanTheTrueOneAndLittleLess) {
  for_each_seed(test::rounds(6), [](std::mt19937& random) {
    const Scene scene = distance_scene(random, whole(random, 1, 3), 3, named_coding("paper", 5));
    const ViscosityField field = build_field(scene).field;
    int kept = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 p = random_point(random, field);
      const FieldSample sample = field.at(p);
      if (sample.distance_m < 0 || in_skin(sample)) continue;
      ++kept;
      const double d = true_distance(scene, p);
      EXPECT_LE(sample.distance_m, d * (1 + 1e-12)) << p.transpose();
      // Half a diagonal of margin, and as much again where the surface bends between centres.
      if (sample.record.kind == VoxelKind::neighbour) {
        EXPECT_GE(sample.distance_m, d - 2.1 * half_diagonal_vox * h) << p.transpose();
      }
    }
    EXPECT_GT(kept, 400);
  });
}

TEST(DistanceField, ViscosityIsNeverLessThanThatOfTheTrueDistanceWhereTheCodingIsConvex) {
  const Coding convex{{32, 24, 18, 13, 9, 6, 3.5, 1.5}, 100};
  for_each_seed(test::rounds(6), [&](std::mt19937& random) {
    const Scene scene = distance_scene(random, whole(random, 1, 3), 2, convex);
    const ViscosityField field = build_field(scene).field;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 p = random_point(random, field);
      const FieldSample sample = field.at(p);
      if (in_skin(sample)) continue;
      const double honest = convex.at_distance(true_distance(scene, p) / h, 2, 8);
      EXPECT_GE(sample.viscosity, honest - 1e-9) << p.transpose();
    }
  });
}

TEST(DistanceField, ViscosityIsNeverLessThanThatOfTheTrueDistanceAndAVoxelForAnyFallingCoding) {
  const Coding paper = named_coding("paper", 6);
  for_each_seed(test::rounds(6), [&](std::mt19937& random) {
    const Scene scene = distance_scene(random, whole(random, 1, 3), 4, paper);
    const ViscosityField field = build_field(scene).field;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 p = random_point(random, field);
      const FieldSample sample = field.at(p);
      if (in_skin(sample)) continue;
      const double d = true_distance(scene, p) / h;
      EXPECT_GE(sample.viscosity, paper.at_distance(d + half_diagonal_vox + 1e-9, 4, 6) - 1e-9);
    }
  });
}

TEST(DistanceField, ViscosityHasNoStepOutsideTheSkin) {
  for_each_seed(test::rounds(6), [](std::mt19937& random) {
    const int m = whole(random, 1, 4);
    const Coding coding{{32, 20, 13, 11, 10}, 100};
    const ViscosityField field =
        build_field(distance_scene(random, whole(random, 1, 3), m, coding)).field;
    // The steepest rank, between two centres, along each axis at once; the stored distances are
    // rounded, and two objects in turn may hold the centres.
    const double steepest_per_vox = 12.0 / m * (1 + distance_step_vox) * std::sqrt(3.0);
    for (int line = 0; line < 20; ++line) {
      const Vec3 from = random_point(random, field);
      const Vec3 to = random_point(random, field);
      constexpr int steps = 4000;
      const double step_vox = (to - from).norm() / h / steps;
      FieldSample before = field.at(from);
      for (int n = 1; n <= steps; ++n) {
        const FieldSample now = field.at(from + (to - from) * n / steps);
        if (!in_skin(before) && !in_skin(now)) {
          EXPECT_LE(std::abs(now.viscosity - before.viscosity),
                    steepest_per_vox * step_vox + 1e-12);
        }
        before = now;
      }
    }
  });
}

TEST(DistanceField, TheSkinAndTheInsideAreAsTheyAre) {
  for_each_seed(3, [](std::mt19937& random) {
    const ViscosityField field =
        build_field(distance_scene(random, 2, 2, {{32, 25, 20}, 90})).field;
    int skins = 0;
    for (int n = 0; n < 20000; ++n) {
      const FieldSample sample = field.at(random_point(random, field));
      if (!in_skin(sample)) continue;
      ++skins;
      EXPECT_EQ(sample.viscosity, 90);
      EXPECT_EQ(sample.distance_m, 0);
    }
    EXPECT_GT(skins, 50);
  });
}

TEST(DistanceField, BesideRankedObjectsItIsStillNeverOptimistic) {
  for_each_seed(test::rounds(6), [](std::mt19937& random) {
    Scene scene = distance_scene(random, 3, 3, {{30, 20, 12, 6, 2}, 100});
    scene.objects[0].layers = LayerShape::sphere;
    const ViscosityField field = build_field(scene).field;
    Scene measured = scene;
    measured.objects.erase(measured.objects.begin());
    for (int n = 0; n < 6000; ++n) {
      const Vec3 p = random_point(random, field);
      const FieldSample sample = field.at(p);
      if (in_skin(sample)) continue;
      const VoxelRecord& record = sample.record;
      const bool ranked = record.kind == VoxelKind::neighbour &&
                          field.objects()[record.object].layers == LayerShape::sphere;
      if (ranked) {
        EXPECT_EQ(sample.viscosity, field.objects()[record.object].coding.of_rank(record.rank));
        EXPECT_LT(sample.distance_m, 0);
      } else if (sample.distance_m >= 0) {
        EXPECT_LE(sample.distance_m, true_distance(measured, p) * (1 + 1e-12)) << p.transpose();
      }
    }
  });
}

TEST(DistanceField, TheEdgeOfTheWorkspaceHidesNothing) {
  for_each_seed(test::rounds(4), [](std::mt19937& random) {
    const Coding convex{{30, 20, 12, 6, 2}, 100};
    Scene scene = distance_scene(random, 1, 3, convex);
    const Box box = std::get<TriangleMesh>(scene.objects[0].shape).bounds();
    scene.bounds = Box(box.max() - Vec3::Constant(6 * h), box.max() + Vec3::Constant(9 * h));
    const ViscosityField field = build_field(scene).field;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 p = random_point(random, field);
      const FieldSample sample = field.at(p);
      if (in_skin(sample)) continue;
      const double d = true_distance(scene, p);
      EXPECT_LE(sample.distance_m, d * (1 + 1e-12)) << p.transpose();
      EXPECT_GE(sample.viscosity, convex.at_distance(d / h, 3, 5) - 1e-9) << p.transpose();
    }
  });
}

}  // namespace
}  // namespace vicinity
