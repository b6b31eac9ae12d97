// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/mesh_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "allocation_meter.h"
#include "mesh_data.h"
#include "rounds.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/inspection.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/mesh/stl_file.h"

namespace vicinity {
namespace {

using ::testing::HasSubstr;

std::string obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Vec3& v : mesh.vertices) text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& t : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

std::string ply_header(const TriangleMesh& mesh, const char* format) {
  return fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, mesh.vertices.size(), mesh.triangles.size());
}

std::string ascii_ply(const TriangleMesh& mesh) {
  std::string text = ply_header(mesh, "ascii");
  for (const Vec3& v : mesh.vertices) text += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& t : mesh.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

void put(std::string& bytes, const auto& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_ply(const TriangleMesh& mesh) {
  std::string bytes = ply_header(mesh, "binary_little_endian");
  for (const Vec3& v : mesh.vertices) {
    for (const double x : v) put(bytes, static_cast<float>(x));
  }
  for (const auto& t : mesh.triangles) {
    bytes += '\x03';
    put(bytes, t);
  }
  return bytes;
}

/// GLB with one node that places the mesh by a column-major matrix.
std::string glb(const TriangleMesh& mesh, const std::string& matrix) {
  std::string buffer;
  for (const Vec3& v : mesh.vertices) {
    for (const double x : v) put(buffer, static_cast<float>(x));
  }
  const std::size_t points = buffer.size();
  for (const auto& t : mesh.triangles) put(buffer, t);
  const Box box = mesh.bounds();
  std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0,"matrix":[{}]}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3",)"
      R"("min":[{},{},{}],"max":[{},{},{}]}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{}}},)"
      R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],"buffers":[{{"byteLength":{}}}]}})",
      matrix, mesh.vertices.size(), box.min().x(), box.min().y(), box.min().z(), box.max().x(),
      box.max().y(), box.max().z(), 3 * mesh.triangles.size(), points, points,
      buffer.size() - points, buffer.size());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes;
  put(bytes, std::array<std::uint32_t, 3>{
                 0x46546C67, 2, static_cast<std::uint32_t>(28 + json.size() + buffer.size())});
  put(bytes, std::array<std::uint32_t, 2>{static_cast<std::uint32_t>(json.size()), 0x4E4F534A});
  bytes += json;
  put(bytes, std::array<std::uint32_t, 2>{static_cast<std::uint32_t>(buffer.size()), 0x004E4942});
  return bytes + buffer;
}

/// A tetrahedron, moved by (10, 20, 30) in its node, with the given unit and up axis.
std::string collada(const std::string& metres_per_unit, const std::string& up_axis) {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter=")" +
         metres_per_unit + R"("/><up_axis>)" + up_axis + R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 2 0 0 0 3</float_array>
<technique_common><accessor source="#pa" count="4" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>10 20 30</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string refusal(const std::filesystem::path& path) {
  try {
    read_mesh(path);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

void expect_whole(const TriangleMesh& mesh, const TriangleMesh& original) {
  const MeshInspection found = inspect(mesh);
  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.triangles, original.triangles.size());
  EXPECT_EQ(mesh.vertices.size(), original.vertices.size());
  EXPECT_NEAR(volume(mesh), volume(original), 1e-6);
}

TEST(MeshFile, EveryKindBringsTheSameMeshWhateverTheCaseOfItsExtension) {
  const ScratchFolder folder;
  const TriangleMesh mesh = primitive::torus(0.5, 0.2, 16);
  const std::string unmoved = "1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1";
  expect_whole(read_mesh(folder.file("a.obj", obj(mesh))), mesh);
  expect_whole(read_mesh(folder.file("a.OBJ", obj(mesh))), mesh);
  expect_whole(read_mesh(folder.file("a.ply", ascii_ply(mesh))), mesh);
  expect_whole(read_mesh(folder.file("b.Ply", binary_ply(mesh))), mesh);
  expect_whole(read_mesh(folder.file("a.glb", glb(mesh, unmoved))), mesh);
  write_stl(mesh, folder.path() / "a.Stl");
  expect_whole(read_mesh(folder.path() / "a.Stl"), mesh);
}

TEST(MeshFile, NodesPlaceTheMeshAndAMirrorKeepsItsOutside) {
  const ScratchFolder folder;
  const TriangleMesh box = primitive::box(Vec3(1, 2, 4));
  const TriangleMesh mesh =
      read_mesh(folder.file("a.glb", glb(box, "-1,0,0,0, 0,1,0,0, 0,0,2,0, 10,20,30,1")));
  EXPECT_TRUE(mesh.bounds().min().isApprox(Vec3(9.5, 19, 26)));
  EXPECT_TRUE(mesh.bounds().max().isApprox(Vec3(10.5, 21, 34)));
  EXPECT_NEAR(volume(mesh), 16, 1e-9);
}

TEST(MeshFile, PolygonsAreCutAndPointsAndLinesAreLeftOut) {
  const ScratchFolder folder;
  // An L of six corners, which a fan from its first corner would overlap itself on.
  const TriangleMesh mesh = read_mesh(
      folder.file("l.obj",
                  "v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 9 9 9\nf 1 2 3 4 5 6\n"
                  "l 1 7\np 7\n"));
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(surface_area(mesh), 3, 1e-12);
  EXPECT_EQ(mesh.bounds().max(), Vec3(2, 2, 0));
}

TEST(MeshFile, ColladaKeepsTheNumbersOfTheFileWhateverItsUnitAndUpAxis) {
  const ScratchFolder folder;
  for (const char* unit : {"1", "0.0254", "0.001"}) {
    for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
      SCOPED_TRACE(fmt::format("{} {}", unit, up));
      const TriangleMesh mesh = read_mesh(folder.file("a.dae", collada(unit, up)));
      EXPECT_EQ(mesh.bounds().min(), Vec3(10, 20, 30));
      EXPECT_EQ(mesh.bounds().max(), Vec3(11, 22, 33));
      EXPECT_NEAR(volume(mesh), 1, 1e-9);
    }
  }
}

TEST(MeshFile, AKindThatIsNotReadIsRefusedWithTheKindsThatAre) {
  const ScratchFolder folder;
  for (const char* name : {"a.step", "b.STP", "c.iges"}) {
    EXPECT_THAT(refusal(folder.file(name, "ISO-10303-21;")),
                ::testing::AllOf(HasSubstr(name), HasSubstr("STL, OBJ, PLY"),
                                 HasSubstr("exporting STL from the CAD program")));
  }
  EXPECT_THAT(refusal(folder.file("a.txt", "hello")), HasSubstr("found \".txt\""));
  EXPECT_THAT(refusal(folder.file("mesh", "hello")), HasSubstr("no extension"));
}

TEST(MeshFile, WhatIsNoFileIsRefused) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "folder.obj");
  EXPECT_THAT(refusal(folder.path() / "folder.obj"), HasSubstr("a folder"));
  EXPECT_THAT(refusal(folder.path() / "none.obj"), HasSubstr("there is no such file"));
  const auto pipe = folder.path() / "pipe.ply";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal(pipe), HasSubstr("a device or pipe"));
}

TEST(MeshFile, AFileThatMayNotBeReadIsRefused) {
  const ScratchFolder folder;
  const auto locked = folder.file("locked.obj", "v 0 0 0");
  std::filesystem::permissions(locked, std::filesystem::perms::none);
  if (access(locked.c_str(), R_OK) == 0) GTEST_SKIP() << "this user may read every file";
  EXPECT_THAT(refusal(locked), HasSubstr("cannot be read"));
}

TEST(MeshFile, EmptyAndCutAndSenselessFilesAreRefusedInOneSentence) {
  const ScratchFolder folder;
  const TriangleMesh ball = primitive::sphere(0.5, 32);
  const std::string ply = binary_ply(ball);
  EXPECT_THAT(refusal(folder.file("cut.ply", ply.substr(0, ply.size() / 2))), HasSubstr("cut.ply"));
  EXPECT_THAT(refusal(folder.file("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")),
              HasSubstr("points.obj"));
  EXPECT_THAT(refusal(folder.file(
                  "nan.ply", ascii_ply({.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 3e9, 0)},
                                        .triangles = {{0, 1, 2}}}))),
              HasSubstr("triangle 1 of 1"));
  for (const char* kind : {"obj", "ply", "gltf", "glb", "dae", "3mf", "fbx"}) {
    for (const std::string& bytes : {std::string(), std::string("\0\x01garbage\n", 10)}) {
      const std::string said = refusal(folder.file(fmt::format("bad.{}", kind), bytes));
      EXPECT_THAT(said, HasSubstr(fmt::format("bad.{}", kind)));
      EXPECT_EQ(said.find('\n'), said.npos);
    }
  }
}

// Otherwise whoever sends a mesh reads files of this machine by the mesh's coordinates.
TEST(MeshFile, AMeshReadsNoFileOutsideItsOwnFolder) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path() / "own/below");
  std::string corners;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) put(corners, x);
  for (const char* name : {"outside.bin", "own/inside.bin", "own/below/deep.bin"}) {
    folder.file(name, corners);
  }
  const auto naming = [&](const std::string& buffer) {
    return folder.file("own/part.gltf", fmt::format(R"({{"asset": {{"version": "2.0"}}, "scene": 0,
        "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "buffers": [{{"uri": "{}", "byteLength": 36}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}]}})",
                                                    buffer));
  };
  for (const char* buffer : {"inside.bin", "below/deep.bin", "below/../inside.bin"}) {
    EXPECT_EQ(read_mesh(naming(buffer)).triangles.size(), 1u) << buffer;
  }
  const std::string absolute = (folder.path() / "outside.bin").string();
  for (const std::string& buffer :
       {std::string("../outside.bin"), std::string("below/../../outside.bin"), absolute}) {
    EXPECT_THAT(refusal(naming(buffer)), HasSubstr("part.gltf")) << buffer;
  }
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path() / "own");
  naming("inside.bin");
  EXPECT_EQ(read_mesh("part.gltf").triangles.size(), 1u);
  naming("../outside.bin");
  EXPECT_THAT(refusal("part.gltf"), HasSubstr("part.gltf"));
  std::filesystem::current_path(before);
}

TEST(MeshFile, ReadingLeavesNoChildNoDescriptorAndNoOutputBehind) {
  const ScratchFolder folder;
  const auto good = folder.file("good.obj", obj(primitive::sphere(0.5, 12)));
  const auto bad = folder.file("bad.ply", binary_ply(primitive::sphere(0.5, 12)).substr(0, 400));
  const auto descriptors = [] {
    const auto open = std::filesystem::directory_iterator("/proc/self/fd");
    return std::distance(begin(open), end(open));
  };
  const auto before = descriptors();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  for (int i = 0; i < 5; ++i) {
    read_mesh(good);
    refusal(bad);
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(descriptors(), before);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(MeshFile, AHostThatIgnoresItsChildrenReadsAllTheSame) {
  const ScratchFolder folder;
  const auto good = folder.file("good.obj", obj(primitive::sphere(0.5, 12)));
  const auto bad = folder.file("bad.ply", binary_ply(primitive::sphere(0.5, 12)).substr(0, 400));
  const auto previous = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_NO_THROW(read_mesh(good));
  EXPECT_NE(refusal(bad), "");
  std::signal(SIGCHLD, previous);
}

TEST(MeshFile, SeveralThreadsMayReadAtTheSameTime) {
  const ScratchFolder folder;
  const TriangleMesh mesh = primitive::sphere(0.5, 32);
  const auto path = folder.file("a.obj", obj(mesh));
  std::vector<TriangleMesh> meshes(4);
  {
    std::vector<std::jthread> threads;
    for (TriangleMesh& result : meshes) {
      threads.emplace_back([&] { result = read_mesh(path); });
    }
  }
  for (const TriangleMesh& result : meshes) {
    EXPECT_EQ(result.vertices, meshes[0].vertices);
    EXPECT_EQ(result.triangles, meshes[0].triangles);
  }
}

/// Damages some bytes of a file and cuts some of the results short, then reads them.
void expect_no_harm(const std::string& extension, const std::string& original) {
  const ScratchFolder folder;
  int read = 0;
  for (unsigned seed = 0; seed < test::rounds(40u); ++seed) {
    SCOPED_TRACE(testing::Message() << extension << " seed " << seed);
    std::mt19937 random(seed);
    std::string bytes = original;
    const auto somewhere = [&] {
      return std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random);
    };
    if (seed % 3 == 0) bytes.resize(somewhere() + 1);
    const int damage = std::uniform_int_distribution<int>(1, 10)(random);
    for (int i = 0; i < damage; ++i) {
      bytes[somewhere()] = static_cast<char>(std::uniform_int_distribution<int>(0, 255)(random));
    }
    const auto path = folder.file("damaged" + extension, bytes);
    const AllocationMeter meter;
    try {
      const TriangleMesh mesh = read_mesh(path);
      ++read;
      for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
          ASSERT_LT(corner, mesh.vertices.size());
          ASSERT_LE(mesh.vertices[corner].cwiseAbs().maxCoeff(), 1e9);
        }
      }
    } catch (const Error& error) {
      ASSERT_THAT(error.what(), HasSubstr("damaged" + extension));
    }
    ASSERT_LT(meter.peak(), 20 * bytes.size() + (std::size_t{1} << 20));
  }
  ::testing::Test::RecordProperty("still_read", read);
}

TEST(MeshFile, RandomDamageToObjDoesNoHarm) {
  expect_no_harm(".obj", obj(primitive::sphere(0.5, 8)));
}
TEST(MeshFile, RandomDamageToAsciiPlyDoesNoHarm) {
  expect_no_harm(".ply", ascii_ply(primitive::sphere(0.5, 8)));
}
TEST(MeshFile, RandomDamageToBinaryPlyDoesNoHarm) {
  expect_no_harm(".ply", binary_ply(primitive::sphere(0.5, 8)));
}
TEST(MeshFile, RandomDamageToGlbDoesNoHarm) {
  expect_no_harm(".glb", glb(primitive::sphere(0.5, 8), "1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1"));
}
TEST(MeshFile, RandomDamageToColladaDoesNoHarm) { expect_no_harm(".dae", collada("1", "Z_UP")); }
TEST(MeshFile, RandomDamageToThreeMfDoesNoHarm) {
  const auto data = data_folder();
  if (data.empty()) GTEST_SKIP() << "VICINITY_DATA does not name a folder of real meshes";
  expect_no_harm(".3mf", bytes_of(data / "meshes/cad/featuretype.3MF"));
}
TEST(MeshFile, RandomDamageToFbxDoesNoHarm) {
  const auto data = data_folder();
  if (data.empty()) GTEST_SKIP() << "VICINITY_DATA does not name a folder of real meshes";
  expect_no_harm(".fbx", bytes_of(data / "meshes/clean/original_fbx/Plato.fbx"));
}

}  // namespace
}  // namespace vicinity
