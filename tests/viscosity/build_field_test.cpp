// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/build_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "random_scene.h"
#include "rounds.h"
#include "seeds.h"
#include "vicinity/geometry/error.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/mesh/placement.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

using test::for_each_seed;
using test::random_scene;
using test::random_scene_voxel;
using test::whole;
using ::testing::HasSubstr;

bool same_image(const ViscosityField& a, const ViscosityField& b) {
  return std::ranges::equal(a.image(), b.image());
}

SceneObject box_object(const std::string& name, const Vec3& size, const Vec3& centre) {
  SceneObject object;
  object.name = name;
  object.shape = primitive::box(size);
  object.X_WO.translation() = centre;
  return object;
}

/// A box of whole voxels somewhere around the middle of a random scene.
Box cut_out(std::mt19937& random, int least, int most) {
  const auto corner = [&](int lo, int hi) {
    return Vec3(whole(random, lo, hi), whole(random, lo, hi), whole(random, lo, hi));
  };
  return {random_scene_voxel * corner(-8, least), random_scene_voxel * corner(least + 6, most)};
}

struct Voxel {
  VoxelKind kind = VoxelKind::empty;
  int rank = 0;
  std::string object;
  double viscosity = 0;
  double distance_vox = -1;
  bool operator==(const Voxel&) const = default;
};

Voxel voxel_at(const ViscosityField& field, const VoxelIndex& v) {
  const VoxelCode code = field.code_at(v);
  const VoxelRecord& record = field.records()[code];
  if (record.kind == VoxelKind::empty) return {};
  return {record.kind, record.rank, field.objects()[record.object].name, field.viscosities()[code],
          field.distance_vox_at(v)};
}

/// What one object alone makes of a voxel; viscosity as it competes with other objects.
class LoneObject {
 public:
  LoneObject(const SceneObject& object, const Workspace& workspace) : object_(object) {
    const TriangleMesh& mesh = std::get<TriangleMesh>(object.shape);
    boundary_ = boundary_voxels(mesh, workspace, object.boundary);
    inner_ = inner_voxels(mesh, boundary_, workspace, object.inner);
    if (object.layers == LayerShape::distance) {
      layers_ = distance_layers(mesh, boundary_, inner_, workspace, object.m, object.q);
    } else {
      layers_.neighbours =
          ranked_neighbours(boundary_, inner_, ShapingElement(object.layers, object.m), object.q);
    }
  }

  Voxel at(const VoxelIndex& v) const {
    Voxel voxel;
    if (boundary_.contains(v)) {
      voxel = {VoxelKind::boundary, 0, object_.name, object_.coding.skin, distance(v)};
    } else if (inner_.contains(v)) {
      voxel = {VoxelKind::inner, 0, object_.name, object_.coding.skin, -1};
    }
    for (int n = 1; n <= object_.q; ++n) {
      if (!layers_.neighbours.ranks[static_cast<std::size_t>(n - 1)].contains(v)) continue;
      EXPECT_EQ(voxel.kind, VoxelKind::empty) << "two kinds of one object in one voxel";
      voxel = {VoxelKind::neighbour, n, object_.name, object_.coding.of_rank(n), distance(v)};
    }
    return voxel;
  }

  double weight(const Voxel& voxel) const {
    const bool by_distance =
        voxel.kind == VoxelKind::neighbour && object_.layers == LayerShape::distance;
    return by_distance ? object_.coding.at_distance(voxel.distance_vox - half_diagonal_vox,
                                                    object_.m, object_.q)
                       : voxel.viscosity;
  }

 private:
  double distance(const VoxelIndex& v) const {
    const DistanceBlock* block = layers_.distances.find(block_of(v));
    return block == nullptr ? -1
                            : block->steps[static_cast<std::size_t>(
                                  ((v.k & 7) * 8 + (v.j & 7)) * 64 + (v.i & 63))] /
                                  128.0;
  }

  const SceneObject& object_;
  VoxelSet boundary_, inner_;
  DistanceLayers layers_;
};

/// Voxel by voxel, the field is what its objects alone make of it, by precedence.
void expect_plain_merge(const Scene& scene) {
  const ViscosityField field = build_field(scene).field;

  std::map<std::string, LoneObject> alone;  // in the order of names, in which ties are settled
  for (const SceneObject& o : scene.objects) {
    alone.emplace(o.name, LoneObject(o, field.workspace()));
  }
  const VoxelIndex dims = field.workspace().dims;
  VoxelCounts counts;
  int wrong = 0;
  for (std::int32_t k = 0; k < dims.k; ++k) {
    for (std::int32_t j = 0; j < dims.j; ++j) {
      for (std::int32_t i = 0; i < dims.i; ++i) {
        Voxel winner;
        double weight = 0;
        for (const auto& [name, object] : alone) {
          const Voxel voxel = object.at({i, j, k});
          const double mine = object.weight(voxel);
          if (voxel.kind > winner.kind || (voxel.kind == winner.kind && mine > weight)) {
            winner = voxel;
            weight = mine;
          }
        }
        counts.boundary += winner.kind == VoxelKind::boundary;
        counts.inner += winner.kind == VoxelKind::inner;
        counts.neighbour += winner.kind == VoxelKind::neighbour;
        wrong += !(voxel_at(field, {i, j, k}) == winner);
      }
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(field.voxel_counts().boundary, counts.boundary);
  EXPECT_EQ(field.voxel_counts().inner, counts.inner);
  EXPECT_EQ(field.voxel_counts().neighbour, counts.neighbour);
}

TEST(BuildField, IsThePlainMergeOfItsObjects) {
  for_each_seed(test::rounds(20), [](std::mt19937& random) {
    Scene scene = random_scene(random, whole(random, 1, 5), 28);
    if (whole(random, 0, 1) == 0) scene.bounds = cut_out(random, 10, 50);
    expect_plain_merge(scene);
  });
}

// In a brick that the bounds cut, as many codes as fit may all win, and what lies beyond is one
// more.
TEST(BuildField, ABrickMayHoldAsManyCodesAsThereIsRoomFor) {
  for (int boxes = 26; boxes <= 30; ++boxes) {
    SCOPED_TRACE(boxes);
    Scene scene;
    scene.voxel_size = 1;
    scene.bounds = Box(Vec3::Zero(), Vec3(7, 8, 8));
    int made = 0;
    for (const int x : {1, 4}) {
      for (const int y : {1, 3, 5, 7}) {
        for (const int z : {0, 2, 4, 6}) {
          if (made == boxes) continue;
          SceneObject box = box_object("box " + std::to_string(++made), Vec3::Constant(0.2),
                                       Vec3(x + 0.5, y + 0.5, z + 0.5));
          box.m = box.q = 1;
          box.coding = {{50.0 + made}, 100};
          scene.objects.push_back(box);
        }
      }
    }
    SceneObject floor = box_object("floor", Vec3(30, 30, 0.2), Vec3(4, 4, -1.5));
    floor.m = 1;
    floor.q = 9;
    floor.coding = {{9, 8, 7, 6, 5, 4, 3, 2, 1}, 100};
    scene.objects.push_back(floor);
    // Triangles as they stand where the field is built.
    for (SceneObject& object : scene.objects) {
      object.shape = place(std::get<TriangleMesh>(object.shape), 1, object.X_WO);
      object.X_WO = Pose::Identity();
    }
    expect_plain_merge(scene);
  }
}

TEST(BuildField, DoesNotDependOnTheOrderOfObjectsOrTriangles) {
  for_each_seed(test::rounds(8), [](std::mt19937& random) {
    Scene scene = random_scene(random, 4, 40);
    const ViscosityField field = build_field(scene).field;
    std::shuffle(scene.objects.begin(), scene.objects.end(), random);
    for (SceneObject& object : scene.objects) {
      auto& triangles = std::get<TriangleMesh>(object.shape).triangles;
      std::shuffle(triangles.begin(), triangles.end(), random);
    }
    EXPECT_TRUE(same_image(build_field(scene).field, field));
  });
}

TEST(BuildField, DoesNotDependOnTheNumberOfThreads) {
  for_each_seed(test::rounds(6), [](std::mt19937& random) {
    const Scene scene = random_scene(random, 5, 200);
    const BuildResult one = build_field(scene, {.threads = 1, .progress = {}});
    const BuildResult two = build_field(scene, {.threads = 2, .progress = {}});
    EXPECT_EQ(one.report.threads, 1);
    EXPECT_TRUE(same_image(one.field, two.field));
    EXPECT_EQ(one.report.remarks, two.report.remarks);
  });
}

TEST(BuildField, ASmallerWorkspaceIsACutOutOfALargerOne) {
  for_each_seed(test::rounds(8), [](std::mt19937& random) {
    Scene scene = random_scene(random, 4, 60);
    const ViscosityField all = build_field(scene).field;
    scene.bounds = cut_out(random, 20, 90);
    const ViscosityField part = build_field(scene).field;
    const Vec3 shift = all.workspace().to_grid(part.workspace().origin);
    const VoxelIndex dims = part.workspace().dims;
    int wrong = 0;
    for (std::int32_t k = 0; k < dims.k; ++k) {
      for (std::int32_t j = 0; j < dims.j; ++j) {
        for (std::int32_t i = 0; i < dims.i; ++i) {
          const VoxelIndex there = {i + static_cast<std::int32_t>(shift.x()),
                                    j + static_cast<std::int32_t>(shift.y()),
                                    k + static_cast<std::int32_t>(shift.z())};
          wrong += !(voxel_at(part, {i, j, k}) == voxel_at(all, there));
        }
      }
    }
    EXPECT_EQ(wrong, 0);
  });
}

TEST(BuildField, MovingTheSceneByWholeVoxelsMovesTheField) {
  for_each_seed(test::rounds(8), [](std::mt19937& random) {
    Scene scene = random_scene(random, 4, 40);
    const ViscosityField field = build_field(scene).field;
    const Vec3 shift(whole(random, -99, 99), whole(random, -99, 99), whole(random, -99, 99));
    for (SceneObject& object : scene.objects) {
      for (Vec3& p : std::get<TriangleMesh>(object.shape).vertices) p += random_scene_voxel * shift;
    }
    const ViscosityField moved = build_field(scene).field;
    EXPECT_EQ(moved.workspace().origin, field.workspace().origin + random_scene_voxel * shift);
    ASSERT_EQ(moved.workspace().dims, field.workspace().dims);
    const VoxelIndex dims = field.workspace().dims;
    int wrong = 0;
    for (std::int32_t k = 0; k < dims.k; ++k) {
      for (std::int32_t j = 0; j < dims.j; ++j) {
        for (std::int32_t i = 0; i < dims.i; ++i) {
          wrong += !(voxel_at(field, {i, j, k}) == voxel_at(moved, {i, j, k}));
        }
      }
    }
    EXPECT_EQ(wrong, 0);
  });
}

TEST(BuildField, AutomaticBoundsHoldAllLayersAndStartOnTheGrid) {
  for_each_seed(test::rounds(8), [](std::mt19937& random) {
    const Scene scene = random_scene(random, 3, 60);
    const ViscosityField field = build_field(scene).field;
    // Alone, so that no other object hides a voxel.
    for (const SceneObject& object : scene.objects) {
      Scene alone = scene;
      alone.objects = {object};
      const BuildResult built = build_field(alone);
      const FieldObject& told = built.field.objects()[0];
      EXPECT_EQ(built.report.boundary, told.boundary);
      EXPECT_EQ(built.report.inner, told.inner);
      std::uint64_t ranked = 0;
      for (const std::uint64_t n : told.ranks) ranked += n;
      EXPECT_EQ(built.report.neighbour, ranked);
    }
    const Vec3 origin = field.workspace().origin / random_scene_voxel;
    EXPECT_EQ(origin, Vec3(origin.array().round()));
  });
}

TEST(BuildField, AnObjectSmallerThanAVoxelStillHasABoundary) {
  Scene scene;
  scene.voxel_size = 0.01;
  scene.objects = {box_object("speck", Vec3::Constant(1e-4), Vec3::Constant(0.055))};
  const BuildResult built = build_field(scene);
  EXPECT_EQ(built.report.boundary, 1u);
  EXPECT_EQ(built.field.at(Vec3::Constant(0.055)).record.kind, VoxelKind::boundary);
  EXPECT_EQ(built.field.at(Vec3(0.075, 0.055, 0.055)).record.rank, 1);
}

TEST(BuildField, TiesGoToTheNameThatSortsFirstAndTheHigherSkinWins) {
  Scene scene;
  scene.voxel_size = 0.01;
  scene.objects = {box_object("b", Vec3::Constant(0.1), Vec3::Zero()),
                   box_object("a", Vec3::Constant(0.1), Vec3::Zero())};
  const auto name_at_skin = [&] {
    const ViscosityField field = build_field(scene).field;
    return field.objects()[field.at(Vec3(0.0499, 0.001, 0.001)).record.object].name;
  };
  EXPECT_EQ(name_at_skin(), "a");
  scene.objects[0].coding.skin = 101;
  EXPECT_EQ(name_at_skin(), "b");
}

TEST(BuildField, RemarksNameOpenMeshesIgnoredValuesAndObjectsOutside) {
  Scene scene;
  scene.voxel_size = 0.01;
  scene.bounds = Box(Vec3::Constant(-0.3), Vec3::Constant(0.3));
  scene.objects = {box_object("lid off", Vec3::Constant(0.1), Vec3::Zero()),
                   box_object("far", Vec3::Constant(0.1), Vec3::Constant(5)),
                   box_object("quiet", Vec3::Constant(0.1), Vec3::Zero())};
  std::get<TriangleMesh>(scene.objects[0].shape).triangles.pop_back();
  scene.objects[1].q = 4;
  const auto remarks = build_field(scene).report.remarks;
  EXPECT_THAT(remarks,
              ::testing::UnorderedElementsAre(HasSubstr("'lid off' is open"),
                                              HasSubstr("'far' has 6 coding values for 4 ranks"),
                                              HasSubstr("'far' lies outside the workspace")));
}

TEST(BuildField, ProgressRisesThroughTheStagesToOne) {
  std::mt19937 random(1);
  std::vector<std::string> stages;
  double latest = 0;
  bool rises = true;
  build_field(random_scene(random, 3, 30),
              {.threads = 2, .progress = [&](std::string_view stage, double done) {
                 if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
                 rises &= done >= latest && done <= 1;
                 latest = done;
               }});
  EXPECT_THAT(stages, ::testing::ElementsAre("read", "rank", "merge"));
  EXPECT_TRUE(rises);
  EXPECT_NEAR(latest, 1, 1e-9);
}

std::string error_of(const Scene& scene) {
  try {
    build_field(scene);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(BuildField, WhatCannotBeBuiltIsAnErrorThatNamesTheObject) {
  Scene good;
  good.voxel_size = 0.01;
  good.objects = {box_object("one", Vec3::Constant(0.1), Vec3::Zero())};
  ASSERT_EQ(error_of(good), "no error");
  const auto with = [&](auto change) {
    Scene scene = good;
    change(scene, scene.objects[0]);
    return error_of(scene);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  using S = Scene;
  using O = SceneObject;
  EXPECT_THAT(with([](S& s, O&) { s.objects.clear(); }), HasSubstr("no objects"));
  EXPECT_THAT(with([](S& s, O&) { s.objects.push_back(s.objects[0]); }),
              HasSubstr("object 'one': two objects have this name"));
  EXPECT_THAT(with([](S& s, O&) { s.voxel_size = 0; }), HasSubstr("voxel_size"));
  EXPECT_THAT(with([](S& s, O&) { s.voxel_size = nan; }), HasSubstr("voxel_size"));
  EXPECT_THAT(with([](S& s, O&) { s.voxel_size = 1e-9; }), HasSubstr("'one'"));
  EXPECT_THAT(with([](S&, O& o) { o.m = 9; }), HasSubstr("'one': m"));
  EXPECT_THAT(with([](S&, O& o) { o.q = 33; }), HasSubstr("'one': q"));
  EXPECT_THAT(with([](S&, O& o) { o.q = 7; }), HasSubstr("'one': the coding is shorter"));
  EXPECT_THAT(with([](S&, O& o) { o.scale = -1; }), HasSubstr("'one': scale"));
  EXPECT_THAT(with([](S&, O& o) { o.X_WO.translation().x() = nan; }), HasSubstr("'one': the pose"));
  EXPECT_THAT(with([](S&, O& o) { o.X_WO.translation().x() = 1e12; }),
              HasSubstr("'one': too large"));
  EXPECT_THAT(with([](S&, O& o) { o.scale = 1e6; }), HasSubstr("'one': too large"));
  // Few voxels in a box that holds too many, within bounds and without.
  const auto add_far_away = [](S& s, O& o) {
    TriangleMesh& mesh = std::get<TriangleMesh>(o.shape);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& p : primitive::box(Vec3::Constant(0.1)).vertices) {
      mesh.vertices.push_back(p + Vec3::Constant(500));
    }
    for (auto [a, b, c] : primitive::box(Vec3::Constant(0.1)).triangles) {
      mesh.triangles.push_back({first + a, first + b, first + c});
    }
    s.bounds = Box(Vec3::Constant(-1), Vec3::Constant(1));
  };
  EXPECT_THAT(with(add_far_away), HasSubstr("'one': too large"));
  EXPECT_THAT(with([](S& s, O&) {
                s.objects.push_back(box_object("two", Vec3::Constant(0.1), Vec3::Constant(500)));
              }),
              HasSubstr("too small for these bounds"));
  EXPECT_THAT(with([](S&, O& o) { o.coding.skin = 1e39; }), HasSubstr("the skin"));
  EXPECT_THAT(with([](S&, O& o) { o.shape = TriangleMesh{}; }), HasSubstr("'one'"));
  EXPECT_THAT(with([](S&, O& o) { std::get<TriangleMesh>(o.shape).vertices[0].x() = nan; }),
              HasSubstr("'one': a triangle"));
  EXPECT_THAT(with([](S&, O& o) { std::get<TriangleMesh>(o.shape).triangles[0][0] = 99; }),
              HasSubstr("'one': a triangle"));
  EXPECT_THAT(with([](S&, O& o) {
                o.shape = MeshFile{"missing.stl", LengthUnit::metre};
              }),
              HasSubstr("object 'one', missing.stl"));
  EXPECT_THAT(with([](S&, O& o) { o.name = "\xff"; }), HasSubstr("name"));
  EXPECT_THROW(build_field(good, {.threads = -1, .progress = {}}), Error);
}

}  // namespace
}  // namespace vicinity
