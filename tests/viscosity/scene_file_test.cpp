// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "seeds.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/mesh/stl_file.h"

namespace vicinity {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Scene parse(const std::string& text) { return parse_scene(text, "/folder", "cell.yaml"); }

std::string error_of(const std::string& text) {
  try {
    parse(text);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

const std::string good = R"(voxel_size: 0.004
bounds: [[-1, -1, 0], [1, 1, 2]]
defaults: {m: 3, q: 5, shape: cube, coding: [9, 8, 7, 6, 5], skin: 50, inner: raster}
objects:
  - name: bench
    mesh: meshes/bench.stl
    units: mm
    pose: {xyz: [1.0, 2, 3], rpy: [0, 0, 1.5707963267948966]}
    q: 4
    boundary: probe
  - name: vessel
    primitive: {cylinder: {radius: 0.4, height: 1.2}}
    pose: {quaternion: [0, 0, 2, 0]}
    scale: 2
    m: 2
    q: 12
    shape: distance
    coding: jnd
    skin: 80
    inner: none
robot:
  urdf: arm.urdf
  base: {xyz: [0, 0, 0.8]}
  points_per_m2: 500
  exclude: [base_link, link_1]
  tool: tool_frame
)";

TEST(SceneFile, EveryKeyArrives) {
  const Scene scene = parse(good);
  EXPECT_EQ(scene.voxel_size, 0.004);
  ASSERT_TRUE(scene.bounds);
  EXPECT_EQ(scene.bounds->min(), Vec3(-1, -1, 0));
  EXPECT_EQ(scene.bounds->max(), Vec3(1, 1, 2));
  ASSERT_EQ(scene.objects.size(), 2u);

  const SceneObject& bench = scene.objects[0];
  EXPECT_EQ(bench.name, "bench");
  const auto& file = std::get<MeshFile>(bench.shape);
  EXPECT_EQ(file.path, "/folder/meshes/bench.stl");
  EXPECT_EQ(file.units, LengthUnit::millimetre);
  EXPECT_TRUE((bench.X_WO * Vec3(1, 0, 0)).isApprox(Vec3(1, 3, 3)));
  EXPECT_EQ(bench.m, 3);
  EXPECT_EQ(bench.q, 4);
  EXPECT_EQ(bench.layers, LayerShape::cube);
  EXPECT_EQ(bench.boundary, BoundaryMethod::probe);
  EXPECT_EQ(bench.inner, InnerMethod::raster);
  EXPECT_THAT(bench.coding.mu, ElementsAre(9, 8, 7, 6, 5));
  EXPECT_EQ(bench.coding.skin, 50);

  const SceneObject& vessel = scene.objects[1];
  EXPECT_EQ(std::get<TriangleMesh>(vessel.shape).triangles.size(),
            primitive::cylinder(0.4, 1.2).triangles.size());
  EXPECT_TRUE((vessel.X_WO * Vec3(1, 0, 0)).isApprox(Vec3(-1, 0, 0)));
  EXPECT_EQ(vessel.scale, 2);
  EXPECT_EQ(vessel.layers, LayerShape::distance);
  EXPECT_EQ(vessel.boundary, BoundaryMethod::exact);
  EXPECT_EQ(vessel.inner, InnerMethod::none);
  EXPECT_EQ(vessel.coding.mu, named_coding("jnd", 12).mu);
  EXPECT_EQ(vessel.coding.skin, 80);

  ASSERT_TRUE(scene.robot);
  EXPECT_EQ(scene.robot->urdf, "/folder/arm.urdf");
  EXPECT_EQ(scene.robot->X_WB.translation(), Vec3(0, 0, 0.8));
  EXPECT_EQ(scene.robot->points_per_m2, 500);
  EXPECT_THAT(scene.robot->exclude, ElementsAre("base_link", "link_1"));
  EXPECT_EQ(scene.robot->tool, "tool_frame");
}

TEST(SceneFile, WhatIsLeftOutIsTheDefault) {
  const Scene scene = parse("objects: [{name: a, primitive: {sphere: {radius: 1}}}]");
  EXPECT_EQ(scene.voxel_size, 0.005);
  EXPECT_FALSE(scene.bounds);
  EXPECT_FALSE(scene.robot);
  EXPECT_EQ(scene.objects[0].m, 4);
  EXPECT_EQ(scene.objects[0].q, 6);
  EXPECT_EQ(scene.objects[0].layers, LayerShape::sphere);
  EXPECT_THAT(scene.objects[0].coding.mu, ElementsAre(32, 25, 20, 17, 15, 13));
  EXPECT_FALSE(parse("bounds: auto\nobjects: []").bounds);
}

TEST(SceneFile, AnObjectsCodingDoesNotLeakIntoTheNext) {
  const Scene scene = parse(R"(
defaults: {coding: linear}
objects:
  - {name: a, primitive: {sphere: {radius: 1}}, coding: [5, 4, 3, 2, 1, 0]}
  - {name: b, primitive: {sphere: {radius: 1}}, q: 3}
)");
  EXPECT_THAT(scene.objects[0].coding.mu, ElementsAre(5, 4, 3, 2, 1, 0));
  EXPECT_THAT(scene.objects[1].coding.mu, ElementsAre(32, 29, 26));
}

TEST(SceneFile, EveryPrimitiveIsKnown) {
  for (const std::string shape :
       {"box: {size: [1, 2, 3]}", "sphere: {radius: 1}", "cylinder: {radius: 1, height: 2}",
        "cone: {base_radius: 1, height: 2}", "torus: {radius: 2, tube_radius: 1}",
        "tube: {outer_radius: 2, inner_radius: 1, height: 1}",
        "extrusion: {outline: [[0, 0], [1, 0], [0, 1]], height: 1}",
        "revolution: {profile: [[0, 0], [1, 0], [1, 1], [0, 1]]}",
        "pipe: {path: [[0, 0, 0], [1, 0, 0], [1, 1, 0]], radius: 0.1, bend_radius: 0.2}",
        "v_block: {size: [1, 1, 1], depth: 0.5}", "complex_cylinder: {radius: 1, height: 1}"}) {
    const Scene scene = parse("objects: [{name: a, primitive: {" + shape + "}}]");
    EXPECT_GT(std::get<TriangleMesh>(scene.objects[0].shape).triangles.size(), 3u) << shape;
  }
}

TEST(SceneFile, AnchorsAndAliasesMayBeUsed) {
  const Scene scene = parse(R"(
objects:
  - {name: a, primitive: &ball {sphere: {radius: 1}}, pose: &here {xyz: [1, 2, 3]}}
  - {name: b, primitive: *ball, pose: *here}
)");
  EXPECT_EQ(scene.objects[1].X_WO.translation(), Vec3(1, 2, 3));
}

TEST(SceneFile, AnUnknownKeyNamesTheNearestOneAndItsLine) {
  EXPECT_THAT(
      error_of("voxel_sise: 1\n"),
      AllOf(StartsWith("cell.yaml:1: "), HasSubstr("'voxel_sise'"), HasSubstr("try voxel_size")));
  EXPECT_THAT(error_of("objects:\n  - name: a\n    unit: mm\n"),
              AllOf(StartsWith("cell.yaml:3: "), HasSubstr("try units")));
  EXPECT_THAT(error_of("defaults:\n  codeing: jnd\n"),
              AllOf(StartsWith("cell.yaml:2: "), HasSubstr("try coding")));
  EXPECT_THAT(error_of("objects:\n- name: a\n  primitive:\n    sfere: {radius: 1}\n"),
              AllOf(StartsWith("cell.yaml:4: "), HasSubstr("try sphere")));
  EXPECT_THAT(error_of("objects:\n- {name: a, primitive: {sphere: {raduis: 1}}}\n"),
              AllOf(StartsWith("cell.yaml:2: "), HasSubstr("try radius")));
  EXPECT_THAT(error_of("objects: []\nrobot: {urdf: a, toool: b}\n"), HasSubstr("try tool"));
  EXPECT_THAT(error_of("objects:\n- {name: a, shape: spheer}\n"), HasSubstr("try sphere"));
}

TEST(SceneFile, WhatCannotBeMeantIsAnErrorWithItsLine) {
  const auto object = [](const std::string& keys) {
    return error_of("objects:\n  - name: a\n    primitive: {sphere: {radius: 1}}\n    " + keys +
                    "\n");
  };
  const auto line = [](int n) { return StartsWith("cell.yaml:" + std::to_string(n)); };
  EXPECT_THAT(error_of(""), HasSubstr("empty"));
  EXPECT_THAT(error_of("[1, 2]"), line(1));
  EXPECT_THAT(error_of("voxel_size: 1\n"), HasSubstr("lacks the key 'objects'"));
  EXPECT_THAT(error_of("a: [\n"), HasSubstr("YAML"));
  EXPECT_THAT(error_of("objects: []\n---\nobjects: []\n"),
              AllOf(line(2), HasSubstr("behind the end")));
  EXPECT_THAT(error_of("\nvoxel_size: big\nobjects: []"), line(2));
  EXPECT_THAT(error_of("voxel_size: -1\nobjects: []"), line(1));
  EXPECT_THAT(error_of("voxel_size: .nan\nobjects: []"), line(1));
  EXPECT_THAT(error_of("bounds: [[0, 0, 0]]\nobjects: []"), line(1));
  EXPECT_THAT(error_of("bounds: [[0, 0, 0], [1, 1, 0]]\nobjects: []"), HasSubstr("not a box"));
  EXPECT_THAT(error_of("bounds: [[0, 0, 0], [1, 1]]\nobjects: []"), HasSubstr("2 values"));
  EXPECT_THAT(error_of("voxel_size: 1\nvoxel_size: 2\nobjects: []"),
              AllOf(line(2), HasSubstr("twice")));
  EXPECT_THAT(error_of("objects: {}"), line(1));
  EXPECT_THAT(error_of("objects:\n- {primitive: {sphere: {radius: 1}}}"),
              AllOf(line(2), HasSubstr("'name'")));
  EXPECT_THAT(error_of("objects:\n- name: a\n"), HasSubstr("mesh or primitive"));
  EXPECT_THAT(object("mesh: a.stl"), HasSubstr("mesh or primitive"));
  EXPECT_THAT(object("units: mm"), AllOf(line(4), HasSubstr("takes no units")));
  EXPECT_THAT(object("m: 9"), AllOf(line(2), HasSubstr("'a': m is out of range")));
  EXPECT_THAT(object("m: 2.5"), AllOf(line(4), HasSubstr("whole number")));
  EXPECT_THAT(object("q: 33"), HasSubstr("q is out of range"));
  EXPECT_THAT(object("q: -1"), HasSubstr("q is out of range"));
  EXPECT_THAT(object("q: 7"), HasSubstr("6 values for q: 7"));
  EXPECT_THAT(object("coding: [1, 2]"), HasSubstr("2 values for q: 6"));
  EXPECT_THAT(object("coding: [1, 2, .nan, 1, 1, 1]"), AllOf(line(4), HasSubstr("'.nan'")));
  EXPECT_THAT(object("coding: [1, 2, -3, 1, 1, 1]"), HasSubstr("not a viscosity"));
  EXPECT_THAT(object("coding: fast"), AllOf(line(4), HasSubstr("'fast'")));
  EXPECT_THAT(object("skin: -.inf"), line(4));
  EXPECT_THAT(object("skin: -2"), HasSubstr("skin"));
  EXPECT_THAT(object("scale: 0"), line(4));
  EXPECT_THAT(object("pose: [1, 2, 3]"), AllOf(line(4), HasSubstr("the pose")));
  EXPECT_THAT(object("pose: {quaternion: [0, 0, 0, 0]}"), HasSubstr("not a rotation"));
  EXPECT_THAT(object("pose: {rpy: [0, 0, 0], quaternion: [0, 0, 0, 1]}"), HasSubstr("not both"));
  EXPECT_THAT(object("boundary: approx"), line(4));
  EXPECT_THAT(error_of("objects:\n- {name: a, primitive: {sphere: {radius: 1}}}\n"
                       "- {name: a, primitive: {sphere: {radius: 1}}}\n"),
              AllOf(line(3), HasSubstr("two objects have this name")));
  EXPECT_THAT(error_of("objects:\n- {name: a, mesh: x.stl, units: furlong}"),
              AllOf(line(2), HasSubstr("'furlong'")));
  EXPECT_THAT(error_of("objects:\n- {name: a, mesh: x.stl}"), line(2));
  EXPECT_THAT(error_of("objects:\n- {name: a, primitive: {sphere: {radius: -1}}}"), line(2));
  EXPECT_THAT(error_of("objects:\n- {name: a, primitive: {sphere: {}}}"), HasSubstr("'radius'"));
  EXPECT_THAT(error_of("objects:\n- {name: a, primitive: {}}"), HasSubstr("one shape"));
  EXPECT_THAT(error_of("objects:\n- {name: a, primitive: {box: {size: [1, 1, -1]}}}"), line(2));
  EXPECT_THAT(error_of("objects:\n- {name: a, primitive: {torus: {radius: 1, tube_radius: 2}}}"),
              line(2));
  EXPECT_THAT(error_of("objects: []\nrobot: {tool: x}"), AllOf(line(2), HasSubstr("'urdf'")));
  EXPECT_THAT(error_of("objects: []\nrobot:\n"), HasSubstr("the robot"));
  EXPECT_THAT(error_of("objects: []\nrobot: {urdf: a, exclude: base}"), HasSubstr("not a list"));
}

TEST(SceneFile, AMeshFileWithoutAUnitPrintsItsThreeReadings) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("vicinity-unit-" + std::to_string(::getpid()) + ".stl");
  write_stl(primitive::box(Vec3(355, 3.125, 20)), path);
  const std::string error = error_of("objects:\n- name: a\n  mesh: " + path.string() + "\n");
  std::filesystem::remove(path);
  EXPECT_THAT(error, AllOf(StartsWith("cell.yaml:3: "), HasSubstr("355"), HasSubstr("mm"),
                           HasSubstr("inches"), HasSubstr("units")));
}

TEST(SceneFile, PathsAreRelativeToTheFile) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("vicinity-scene-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "cell.yaml") << "objects: [{name: a, mesh: b.stl, units: m}]\n";
  const Scene scene = read_scene(folder / "cell.yaml");
  std::filesystem::remove_all(folder);
  EXPECT_EQ(std::get<MeshFile>(scene.objects[0].shape).path, folder / "b.stl");
  EXPECT_THROW(read_scene(folder / "cell.yaml"), Error);
  EXPECT_THROW(read_scene("/"), Error);
}

TEST(SceneFile, ABombDoesNotGoOff) {
  std::string laughs = "bounds: &l0 [ha]\ndefaults:\n";
  for (int n = 1; n < 40; ++n) {
    laughs.append("  &l").append(std::to_string(n)).append(" [1");
    for (int i = 0; i < 9; ++i) laughs.append(", *l").append(std::to_string(n - 1));
    laughs.append("] : 1\n");
  }
  EXPECT_THROW(parse(laughs), Error);
  EXPECT_THROW(parse(std::string(200000, '[')), Error);
  EXPECT_THROW(parse(std::string(200000, '{')), Error);
  EXPECT_THROW(parse(std::string(5 << 20, ' ')), Error);
  EXPECT_THROW(parse("&a [*a]"), Error);
  EXPECT_THROW(parse(", 2]]"), Error);  // documents without end, to yaml-cpp

  // One long outline that many objects share.
  std::string shared = "objects:\n- {name: x, primitive: {extrusion: &o {height: 1, outline: [";
  for (int n = 0; n < 999; ++n) shared.append("[").append(std::to_string(n)).append(", 0], ");
  shared += "[0, 1]]}}}\n";
  for (int n = 0; n < 5000; ++n) {
    shared.append("- {name: n").append(std::to_string(n)).append(", primitive: {extrusion: *o}}\n");
  }
  EXPECT_THROW(parse(shared), Error);
}

TEST(SceneFile, AMutatedSceneIsASceneOrAnError) {
  const std::string letters = "{}[]:,-&*#'\"\n 0129.naeif|>!%@";
  std::string start = good;
  start.replace(start.find("mesh: meshes/bench.stl"), 22, "primitive: {box: {size: [1, 2, 3]}}");
  start.erase(start.find("    units: mm\n"), 14);
  ASSERT_NO_THROW(parse(start));
  test::for_each_seed(3000, [&](std::mt19937& random) {
    std::string text = start;
    for (int edits = test::whole(random, 1, 4); edits > 0; --edits) {
      const auto at =
          static_cast<std::size_t>(test::whole(random, 0, static_cast<int>(text.size()) - 1));
      const char letter = letters[random() % letters.size()];
      switch (test::whole(random, 0, 3)) {
        case 0:
          text[at] = letter;
          break;
        case 1:
          text.insert(at, 1, letter);
          break;
        case 2:
          text.erase(at, random() % 12 + 1);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 40));
      }
      if (text.empty()) text.push_back('a');
    }
    try {
      parse(text);
    } catch (const Error&) {
    }
  });
}

}  // namespace
}  // namespace vicinity
