// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity build, info: what programs may rely on, and what people see.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.h"

namespace vicinity::cli_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

template <class Json>
std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> names;
  for (const auto& item : json.items()) names.push_back(item.key());
  return names;
}

TEST(Build, JsonHasTheDocumentedKeysAndTrueNumbers) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  const Answer answer =
      folder.run({"build", "scene.yaml", "-o", "f.vicinity", "--json", "--threads", "1"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.err, "");
  const auto json = answer.json();
  EXPECT_THAT(keys(json),
              ElementsAre("field", "voxel_size", "origin", "dims", "objects", "voxels",
                          "file_bytes", "peak_rss_bytes", "threads", "seconds", "remarks"));
  EXPECT_EQ(json["field"], "f.vicinity");
  EXPECT_EQ(json["voxel_size"], 0.01);
  EXPECT_EQ(json["origin"].size(), 3u);
  EXPECT_EQ(json["dims"].size(), 3u);
  ASSERT_EQ(json["objects"].size(), 2u);
  EXPECT_THAT(keys(json["objects"][0]),
              ElementsAre("name", "triangles", "closed", "boundary", "inner", "ranks"));
  EXPECT_EQ(json["objects"][0]["ranks"].size(), 3u);
  EXPECT_EQ(json["objects"][1]["name"], "block");  // sorted by name
  EXPECT_EQ(json["objects"][1]["triangles"], 12);
  EXPECT_EQ(json["objects"][1]["closed"], true);
  EXPECT_THAT(keys(json["voxels"]), ElementsAre("boundary", "inner", "neighbour"));
  EXPECT_THAT(keys(json["seconds"]),
              ElementsAre("read", "voxelise", "fill", "rank", "merge", "write", "total"));
  EXPECT_EQ(json["threads"], 1);
  EXPECT_EQ(json["file_bytes"], std::filesystem::file_size(folder / "f.vicinity"));
  EXPECT_GT(json["peak_rss_bytes"], 1'000'000);
}

TEST(Build, InfoCountsTheSameVoxels) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  const auto built = folder.run({"build", "scene.yaml", "-o", "f.vicinity", "--json"}).json();
  const Answer answer = folder.run({"info", "f.vicinity", "--json"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  const auto info = answer.json();
  for (const char* kind : {"boundary", "inner", "neighbour"}) {
    EXPECT_EQ(info["voxels"][kind], built["voxels"][kind]) << kind;
  }
  std::uint64_t ranked = 0;
  for (const auto& n : info["voxels"]["ranks"]) ranked += n.get<std::uint64_t>();
  EXPECT_EQ(ranked, built["voxels"]["neighbour"]);
  EXPECT_EQ(info["origin"], built["origin"]);
  EXPECT_EQ(info["dims"], built["dims"]);
}

TEST(Build, TellsPeopleWhatItMadeAndWhatToDoNext) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  const Answer answer = folder.run({"build", "scene.yaml", "-o", "f.vicinity"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("block"));
  EXPECT_THAT(answer.out, HasSubstr("bound"));
  EXPECT_THAT(answer.out, HasSubstr("vicinity slice f.vicinity"));
  EXPECT_THAT(folder.files(), ElementsAre("f.vicinity", "scene.yaml"));
}

TEST(Build, TheCommandLineWinsOverTheScene) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  const Answer answer =
      folder.run({"build", "scene.yaml", "-o", "f.vicinity", "--voxel-size", "0.02", "--q", "2",
                  "--m", "1", "--shape", "cube", "--coding", "jnd", "--skin", "77", "--bounds",
                  "-0.2,-0.2,-0.2,0.4,0.2,0.2"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  const auto info = folder.run({"info", "f.vicinity", "--json"}).json();
  EXPECT_EQ(info["voxel_size"], 0.02);
  EXPECT_EQ(info["dims"], (nlohmann::ordered_json{30, 20, 20}));
  for (const auto& object : info["objects"]) {
    EXPECT_EQ(object["layers"], "cube");
    EXPECT_EQ(object["m"], 1);
    EXPECT_EQ(object["q"], 2);
    EXPECT_EQ(object["skin"], 77);
    EXPECT_NEAR(object["coding"][1], 32 / 1.34, 0.05);
  }
}

TEST(Build, OneMeshWithAUnitIsASceneOfOneObject) {
  const Folder folder;
  folder.write("tetra.stl", R"(solid t
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 100 0 vertex 100 0 0 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 100 0 0 vertex 0 0 100 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0 100 vertex 0 100 0 endloop endfacet
facet normal 0 0 0 outer loop vertex 100 0 0 vertex 0 100 0 vertex 0 0 100 endloop endfacet
endsolid t
)");
  const Answer answer = folder.run({"build", "tetra.stl", "--units", "mm", "--voxel-size", "0.01",
                                    "-o", "f.vicinity", "--json"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.json()["objects"][0]["name"], "tetra");
  EXPECT_EQ(answer.json()["objects"][0]["triangles"], 4);

  const Answer unsaid = folder.run({"build", "tetra.stl", "-o", "g.vicinity"});
  EXPECT_EQ(unsaid.code, 2);
  for (const char* reading : {"mm", "m", "inch", "--units"}) {
    EXPECT_THAT(unsaid.err, HasSubstr(reading));
  }
}

TEST(Build, MeshesAreFoundInAnotherFolderWhenTold) {
  const Folder folder;
  std::filesystem::create_directory(folder / "elsewhere");
  folder.write("elsewhere/flat.stl",
               "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\n"
               "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n");
  folder.write("scene.yaml",
               "voxel_size: 0.05\nobjects:\n  - {name: flat, mesh: flat.stl, units: m}\n");
  EXPECT_EQ(folder.run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 2);
  const Answer answer =
      folder.run({"build", "scene.yaml", "--meshes", "elsewhere", "-o", "f.vicinity", "--json"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.json()["objects"][0]["closed"], false);
  EXPECT_FALSE(answer.json()["remarks"].empty());
}

TEST(Build, PathsMayHoldBlanks) {
  const Folder folder;
  folder.write("my scene.yaml", small_scene);
  const Answer answer = folder.run({"build", "my scene.yaml", "-o", "my field.vicinity"});
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "my field.vicinity"));
}

TEST(Build, ThreadsDoNotChangeAByte) {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  for (const char* n : {"1", "2"}) {
    ASSERT_EQ(folder.run({"build", "scene.yaml", "--threads", n, "-o", std::string(n) + ".f"}).code,
              0);
  }
  EXPECT_EQ(text_of(folder / "1.f"), text_of(folder / "2.f"));
}

}  // namespace
}  // namespace vicinity::cli_test
