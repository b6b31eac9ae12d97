// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity check: the verdict in words, in JSON, and in the exit code.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.h"

namespace vicinity::cli_test {
namespace {

using testing::HasSubstr;

constexpr const char* open_square = R"(solid
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 25 0 0
vertex 25 50 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 25 50 0
vertex 0 50 0
endloop
endfacet
endsolid
)";

TEST(Check, JsonHasTheDocumentedKeys) {
  const Folder folder;
  folder.write("square.stl", open_square);
  const Answer answer = folder.run({"check", "square.stl", "--units", "mm", "--json"});
  EXPECT_EQ(answer.code, 0) << answer.err;
  const auto json = answer.json();
  EXPECT_EQ(json["verdict"], "usable");
  EXPECT_EQ(json["triangles"], 2);
  EXPECT_EQ(json["closed"], false);
  EXPECT_EQ(json["shells"], 1);
  EXPECT_DOUBLE_EQ(json["size"][0], 0.025);
  EXPECT_DOUBLE_EQ(json["size"][1], 0.05);
  EXPECT_EQ(json["size"][2], 0);
  ASSERT_FALSE(json["problems"].empty());
  for (const char* key : {"what", "count", "means"}) EXPECT_TRUE(json["problems"][0].contains(key));
}

TEST(Check, WithoutAUnitItShowsAllThreeReadings) {
  const Folder folder;
  folder.write("square.stl", open_square);
  const Answer answer = folder.run({"check", "square.stl"});
  EXPECT_EQ(answer.code, 0) << answer.err;
  for (const char* reading : {"open", " mm if", " m if m", "if inches", "--units"}) {
    EXPECT_THAT(answer.out, HasSubstr(reading));
  }
}

// Such a file says "inch", which is not heeded: nobody may be told that it says nothing.
TEST(Check, AUnitInTheFileIsNotDenied) {
  const Folder folder;
  folder.write("plate.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 2 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
)");
  const Answer check = folder.run({"check", "plate.dae"});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("is not read: say --units"));
  const Answer build = folder.run({"build", "plate.dae", "-o", "f.vicinity"});
  EXPECT_EQ(build.code, 2);
  EXPECT_THAT(build.err, HasSubstr("none is read from mesh files"));
}

TEST(Check, AFileWithoutAMeshIsUnusableForPeopleAndPrograms) {
  const Folder folder;
  folder.write("cut.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0");
  const Answer answer = folder.run({"check", "cut.stl", "--json"});
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, HasSubstr("cut.stl"));
  EXPECT_EQ(answer.json()["verdict"], "unusable");
}

TEST(Check, ATriangleWithoutExtentIsUnusable) {
  const Folder folder;
  folder.write("dot.stl",
               "solid\nfacet normal 0 0 1\nouter loop\nvertex 1 1 1\nvertex 1 1 1\n"
               "vertex 1 1 1\nendloop\nendfacet\nendsolid\n");
  const Answer answer = folder.run({"check", "dot.stl", "--json"});
  EXPECT_EQ(answer.code, 2);
  EXPECT_EQ(answer.json()["verdict"], "unusable");
}

}  // namespace
}  // namespace vicinity::cli_test
