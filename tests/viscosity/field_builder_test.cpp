// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "random_scene.h"
#include "rounds.h"
#include "seeds.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/placement.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/mesh/stl_file.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

using test::for_each_seed;
using test::random_scene;
using test::random_scene_voxel;
using test::real;
using test::whole;

/// Whether a builder with a past makes the bytes that a build from nothing makes.
void expect_as_built_anew(FieldBuilder& builder, const Scene& scene, int ranked) {
  const BuildResult kept = builder.build(scene);
  const BuildResult anew = build_field(scene);
  EXPECT_TRUE(std::ranges::equal(kept.field.image(), anew.field.image()));
  EXPECT_EQ(kept.report.objects_ranked, ranked);
  EXPECT_EQ(kept.report.remarks, anew.report.remarks);
  EXPECT_EQ(kept.report.boundary, anew.report.boundary);
  EXPECT_EQ(kept.report.inner, anew.report.inner);
  EXPECT_EQ(kept.report.neighbour, anew.report.neighbour);
}

Scene scene_in_bounds(std::mt19937& random, int objects, double extent_vox) {
  Scene scene = random_scene(random, objects, extent_vox);
  const double h = random_scene_voxel;
  scene.bounds = Box(Vec3::Constant(-20 * h), Vec3::Constant((extent_vox + 20) * h));
  return scene;
}

TEST(FieldBuilder, RanksOnlyWhatChangedAndMakesTheSameBytes) {
  for_each_seed(test::rounds(12), [](std::mt19937& random) {
    Scene scene = scene_in_bounds(random, 5, 150);
    FieldBuilder builder;
    expect_as_built_anew(builder, scene, 5);
    for (int step = 0; step < 6; ++step) {
      SceneObject& object = scene.objects[static_cast<std::size_t>(whole(random, 0, 4))];
      int ranked = 1;
      switch (whole(random, 0, 4)) {
        case 0:
          object.X_WO.translation().x() += real(random, -0.3, 0.3);
          break;
        case 1:  // other viscosities: nothing to rank, but other winners
          object.coding.skin += 50;
          std::ranges::reverse(object.coding.mu);
          ranked = 0;
          break;
        case 2:  // the mesh itself
          std::get<TriangleMesh>(object.shape).vertices[0].x() += 3 * random_scene_voxel;
          break;
        case 3:  // another order says nothing
          std::shuffle(scene.objects.begin(), scene.objects.end(), random);
          ranked = 0;
          break;
        default:
          object.m = object.m % 3 + 1;
      }
      expect_as_built_anew(builder, scene, ranked);
    }
  });
}

TEST(FieldBuilder, ObjectsComeAndGo) {
  std::mt19937 random(3);
  Scene scene = scene_in_bounds(random, 4, 100);
  FieldBuilder builder;
  expect_as_built_anew(builder, scene, 4);
  const SceneObject gone = scene.objects.back();
  scene.objects.pop_back();
  expect_as_built_anew(builder, scene, 0);
  scene.objects.push_back(gone);
  expect_as_built_anew(builder, scene, 1);
}

TEST(FieldBuilder, AnotherGridRanksEverything) {
  std::mt19937 random(4);
  Scene scene = scene_in_bounds(random, 3, 60);
  FieldBuilder builder;
  expect_as_built_anew(builder, scene, 3);
  scene.voxel_size *= 1.25;
  expect_as_built_anew(builder, scene, 3);
  // The same origin with more room: voxels stay, regions do not.
  scene.bounds = Box(scene.bounds->min(), scene.bounds->max() + Vec3::Constant(0.5));
  expect_as_built_anew(builder, scene, 0);
}

TEST(FieldBuilder, AnErrorLeavesItAsItWas) {
  std::mt19937 random(5);
  Scene scene = scene_in_bounds(random, 3, 60);
  FieldBuilder builder;
  expect_as_built_anew(builder, scene, 3);
  Scene broken = scene;
  broken.objects[1].shape = MeshFile{"missing.stl", LengthUnit::metre};
  EXPECT_THROW(builder.build(broken), Error);
  scene.objects[0].X_WO.translation().y() += 0.1;
  expect_as_built_anew(builder, scene, 1);
}

TEST(FieldBuilder, AMeshFileThatWasWrittenAnewIsReadAnew) {
  const auto folder = std::filesystem::temp_directory_path() /
                      ("vicinity_field_builder_" + std::to_string(std::random_device{}()));
  std::filesystem::create_directories(folder);
  const auto path = folder / "part.stl";
  write_stl(primitive::box(Vec3::Constant(0.2)), path);
  Scene scene;
  scene.voxel_size = 0.01;
  scene.bounds = Box(Vec3::Constant(-1), Vec3::Constant(1));
  SceneObject part;
  part.name = "part";
  part.shape = MeshFile{path, LengthUnit::metre};
  scene.objects = {part};
  FieldBuilder builder;
  expect_as_built_anew(builder, scene, 1);
  expect_as_built_anew(builder, scene, 0);
  write_stl(primitive::sphere(0.1, 12), path);
  expect_as_built_anew(builder, scene, 1);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace vicinity
