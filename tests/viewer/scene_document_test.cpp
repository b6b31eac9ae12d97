// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Scene files that go to the page as JSON and come back as YAML.

#include "scene_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "folder.h"
#include "served.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::viewer {
namespace {

void expect_same(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.voxel_size, b.voxel_size);
  ASSERT_EQ(a.bounds.has_value(), b.bounds.has_value());
  if (a.bounds) {
    EXPECT_TRUE(a.bounds->isApprox(*b.bounds, 0));
  }
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t n = 0; n < a.objects.size(); ++n) {
    const SceneObject &x = a.objects[n], &y = b.objects[n];
    EXPECT_EQ(x.name, y.name);
    EXPECT_TRUE(x.X_WO.isApprox(y.X_WO, 0)) << x.name;
    EXPECT_EQ(x.scale, y.scale);
    EXPECT_EQ(x.m, y.m);
    EXPECT_EQ(x.q, y.q);
    EXPECT_EQ(x.layers, y.layers);
    EXPECT_EQ(x.coding.mu, y.coding.mu);
    EXPECT_EQ(x.coding.skin, y.coding.skin);
    ASSERT_EQ(x.shape.index(), y.shape.index());
    if (const auto* mesh = std::get_if<TriangleMesh>(&x.shape)) {
      EXPECT_EQ(mesh->vertices, std::get<TriangleMesh>(y.shape).vertices) << x.name;
    }
  }
}

TEST(SceneDocument, TheHotCellComesBackAsItWas) {
  const std::filesystem::path file = std::filesystem::path(VICINITY_SCENES) / "hot_cell.yaml";
  const viewer_test::ScratchFolder folder;
  SceneDocument document = read_document(file, folder.path());
  EXPECT_FALSE(document.scene.contains("robot"));
  EXPECT_TRUE(std::filesystem::path(document.robot["urdf"].get<std::string>()).is_absolute());
  // As a page sends it.
  document.scene = nlohmann::ordered_json::parse(document.scene.dump());
  const Scene original = read_scene(file);
  expect_same(scene_of(document.scene, folder.path(), {}), original);

  const std::string yaml = yaml_of(document);
  const auto saved = folder.write("saved.yaml", yaml);
  const Scene again = read_scene(saved);
  expect_same(again, original);
  ASSERT_TRUE(again.robot);
  EXPECT_TRUE(again.robot->X_WB.isApprox(original.robot->X_WB, 0));
  EXPECT_EQ(again.robot->tool, original.robot->tool);
  EXPECT_THAT(yaml, testing::HasSubstr("voxel_size: 0.004\n"));
  EXPECT_THAT(yaml, testing::HasSubstr("  - name: floor\n"));
}

TEST(SceneDocument, PlainNamesLeadNowhereElse) {
  for (const char* name : {"a.stl", "A b-c_1.stl", "..."}) {
    EXPECT_EQ(is_plain_name(name), name[0] != '.') << name;
  }
  for (const char* name : {"", "..", ".a", "a/b", "a\\b", "a\nb", " a", "a\x7f", "ü"}) {
    EXPECT_FALSE(is_plain_name(name)) << name;
  }
  EXPECT_FALSE(is_plain_name(std::string(101, 'a')));
  EXPECT_FALSE(is_plain_name(std::string_view("a\0b", 3)));
}

}  // namespace
}  // namespace vicinity::viewer
