// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/stl_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "allocation_meter.h"
#include "mesh_data.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

using ::testing::HasSubstr;
using Corners = std::array<std::array<float, 3>, 3>;

/// Binary STL by the book, for a test that does not trust write_stl().
std::string binary_stl(const std::vector<Corners>& triangles) {
  std::string bytes(80, '\0');
  const auto put = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(triangles.size()));
  for (const Corners& corners : triangles) {
    put(std::array<float, 3>{});
    put(corners);
    put(std::uint16_t{0});
  }
  return bytes;
}

std::string ascii_stl(const std::vector<Corners>& triangles) {
  std::string text = "solid part\n";
  for (const Corners& t : triangles) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const auto& p : t) text += fmt::format("  vertex {} {} {}\n", p[0], p[1], p[2]);
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

std::vector<Corners> corners_of(const TriangleMesh& mesh) {
  std::vector<Corners> triangles;
  for (const auto& t : mesh.triangles) {
    Corners& corners = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      Eigen::Map<Eigen::Vector3f>(corners[i].data()) = mesh.vertices[t[i]].cast<float>();
    }
  }
  return triangles;
}

const Corners one_triangle = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};

/// What read_stl() says of a file with these bytes; empty where it reads it.
std::string stl_refusal(const std::filesystem::path& path) {
  try {
    read_stl(path);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(StlFile, BinaryAndAsciiOfTheSameTrianglesAreTheSameMesh) {
  const ScratchFolder folder;
  const auto triangles = corners_of(primitive::torus(0.7, 0.3, 24));
  const TriangleMesh binary = read_stl(folder.file("b.stl", binary_stl(triangles)));
  const TriangleMesh ascii = read_stl(folder.file("a.stl", ascii_stl(triangles)));
  EXPECT_EQ(binary.triangles, ascii.triangles);
  ASSERT_EQ(binary.vertices.size(), ascii.vertices.size());
  for (std::size_t i = 0; i < binary.vertices.size(); ++i) {
    // fmt prints the shortest decimals that give the float back; ASCII keeps those decimals.
    EXPECT_EQ(binary.vertices[i].cast<float>(), ascii.vertices[i].cast<float>());
  }
}

TEST(StlFile, WhatIsWrittenIsReadBack) {
  const ScratchFolder folder;
  const TriangleMesh mesh = primitive::sphere(0.5, 24);
  write_stl(mesh, folder.path() / "s.stl");
  const TriangleMesh back = read_stl(folder.path() / "s.stl");
  EXPECT_TRUE(corners_of(back) == corners_of(mesh));
  EXPECT_NEAR(volume(back), volume(mesh), 1e-6);
  write_stl(back, folder.path() / "t.stl");
  write_stl(read_stl(folder.path() / "t.stl"), folder.path() / "u.stl");
  EXPECT_TRUE(bytes_of(folder.path() / "t.stl") == bytes_of(folder.path() / "u.stl"));
}

TEST(StlFile, WritingLeavesNothingBesideTheFileAndNothingWhenItFails) {
  const ScratchFolder folder;
  write_stl(primitive::box(Vec3::Ones()), folder.path() / "box.stl");
  EXPECT_THROW(write_stl(primitive::box(Vec3::Ones()), folder.path() / "none" / "box.stl"), Error);
  std::filesystem::create_directories(folder.path() / "taken.stl" / "by a folder");
  EXPECT_THROW(write_stl(primitive::box(Vec3::Ones()), folder.path() / "taken.stl"), Error);
  ASSERT_EQ(::mkfifo((folder.path() / "pipe.stl").c_str(), 0600), 0);
  EXPECT_THROW(write_stl(primitive::box(Vec3::Ones()), folder.path() / "pipe.stl"), Error);
  EXPECT_TRUE(std::filesystem::is_fifo(folder.path() / "pipe.stl"));
  TriangleMesh bad = primitive::box(Vec3::Ones());
  bad.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_stl(bad, folder.path() / "bad.stl"), Error);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename());
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("box.stl", "taken.stl", "pipe.stl"));
}

TEST(StlFile, WeldsAsAMapOfExactCoordinatesWouldInOrderOfFirstAppearance) {
  const ScratchFolder folder;
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    // Few distinct values, so that vertices meet often, some of them only in the last bit.
    const float values[] = {0.0f, -0.0f, 1.0f, std::nextafter(1.0f, 2.0f), -1.0f, 1e-40f, 1e9f};
    std::uniform_int_distribution<std::size_t> pick(0, seed % 2 == 0 ? 6 : 3);
    std::vector<Corners> triangles(std::uniform_int_distribution<std::size_t>(1, 400)(random));
    for (auto& triangle : triangles) {
      for (auto& corner : triangle) {
        for (float& x : corner) x = values[pick(random)];
      }
    }
    const TriangleMesh mesh = read_stl(folder.file("weld.stl", binary_stl(triangles)));
    std::map<std::array<float, 3>, std::uint32_t> numbers;  // -0 and 0 compare equal
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& p = triangles[i][k];
        const auto number = static_cast<std::uint32_t>(numbers.size());
        const auto [at, fresh] = numbers.try_emplace(p, number);
        ASSERT_EQ(mesh.triangles[i][k], at->second);
        ASSERT_EQ(mesh.vertices[at->second], Vec3(p[0], p[1], p[2]));
      }
    }
    EXPECT_EQ(mesh.vertices.size(), numbers.size());
    for (const Vec3& v : mesh.vertices) {
      for (const double x : v) EXPECT_FALSE(x == 0 && std::signbit(x));
    }
  }
}

TEST(StlFile, AnAsciiFileReadInPartsIsTheSameMeshAsItsTrianglesInBinary) {
  const ScratchFolder folder;
  const auto triangles = corners_of(primitive::torus(0.7, 0.3, 200));
  const std::string text = ascii_stl(triangles);
  ASSERT_GT(text.size(), 4u << 20);
  const TriangleMesh binary = read_stl(folder.file("b.stl", binary_stl(triangles)));
  // One solid; two, the second of which begins somewhere in the middle; one with names to trip
  // over.
  std::string two = text;
  two.insert(two.find("\nfacet", two.size() / 2) + 1, "endsolid a\nsolid facet\n");
  const std::string named = "solid a\n" + text.substr(text.find('\n') + 1);
  std::string carriage_returns = text;
  std::replace(carriage_returns.begin(), carriage_returns.end(), '\n', '\r');
  for (const std::string& bytes : {text, two, named, carriage_returns}) {
    const TriangleMesh ascii = read_stl(folder.file("a.stl", bytes));
    ASSERT_EQ(ascii.triangles, binary.triangles);
    ASSERT_EQ(ascii.vertices.size(), binary.vertices.size());
    for (std::size_t i = 0; i < ascii.vertices.size(); ++i) {
      ASSERT_EQ(ascii.vertices[i].cast<float>(), binary.vertices[i].cast<float>());
    }
  }
}

TEST(StlFile, ARefusalNamesTheLineHoweverFarDownALargeFileItIs) {
  const ScratchFolder folder;
  const std::string text = ascii_stl(corners_of(primitive::torus(0.7, 0.3, 200)));
  for (const double where : {0.1, 0.5, 0.9}) {
    std::string bad = text;
    const std::size_t at =
        bad.find("vertex", static_cast<std::size_t>(where * static_cast<double>(text.size())));
    bad.replace(at, 6, "vortex");
    const auto line =
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    EXPECT_THAT(refusal(folder.file("bad.stl", bad)),
                ::testing::AllOf(HasSubstr(fmt::format("line {}", line)),
                                 HasSubstr("found \"vortex\""), HasSubstr("expected \"vertex\"")));
    EXPECT_THAT(refusal(folder.file("cut.stl", text.substr(0, at))),
                ::testing::AllOf(HasSubstr(fmt::format("line {}", line)), HasSubstr("cut short")));
  }
  std::string no_end = text.substr(0, text.rfind("endsolid"));
  EXPECT_THAT(refusal(folder.file("cut.stl", no_end)), HasSubstr("the file is cut short"));
  EXPECT_THAT(refusal(folder.file("blank.stl", "solid" + std::string(3u << 20, '\n'))),
              HasSubstr("cut short"));
}

TEST(StlFile, CountsTheNormalsThatAreZero) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "vicinity_normals.stl";
  write_stl(primitive::box({1, 1, 1}), file);
  EXPECT_EQ(count_zero_normals(file), 0u);
  {
    std::fstream change(file, std::ios::in | std::ios::out | std::ios::binary);
    for (const int triangle : {0, 7}) {
      change.seekp(84 + 50 * triangle);
      change.write("\0\0\0\0\0\0\0\x80\0\0\0\0", 12);  // 0, -0, 0
    }
  }
  EXPECT_EQ(count_zero_normals(file), 2u);
  std::ofstream(file) << "solid x\n facet normal 0 0 0\n outer loop\n vertex 0 0 0\n"
                         " vertex 1 0 0\n vertex 0 1 0\n endloop\n endfacet\n"
                         " facet normal nan nan nan\n outer loop\n vertex 0 0 0\n"
                         " vertex 1 0 0\n vertex 0 1 0\n endloop\n endfacet\n"
                         " facet normal 0 -0.0 0e5\n outer loop\n vertex 0 0 0\n"
                         " vertex 1 0 0\n vertex 0 1 0\n endloop\n endfacet\nendsolid x\n";
  EXPECT_EQ(count_zero_normals(file), 2u);
  std::ofstream(file) << "normal";
  EXPECT_EQ(count_zero_normals(file), 0u);
  std::filesystem::remove(file);
}

TEST(StlFile, TheWordSolidDoesNotMakeAFileAscii) {
  const ScratchFolder folder;
  std::string bytes = binary_stl({one_triangle});
  const std::string header = "solid blah\nendsolid blah";
  bytes.replace(0, header.size(), header);
  EXPECT_EQ(read_stl(folder.file("a.stl", bytes)).triangles.size(), 1u);
  bytes.pop_back();
  EXPECT_THAT(stl_refusal(folder.file("b.stl", bytes)),
              HasSubstr("cut short or its triangle count"));
}

TEST(StlFile, AsciiMayBeWrittenAsPeopleWriteIt) {
  const ScratchFolder folder;
  const char* texts[] = {
      "\r\n\r\n  SOLID Part With Facet In Its Name\r\n\tFACET NORMAL 0 0 1\r\nOUTER LOOP\r\n"
      "VERTEX 0 0 0\r\n\r\nVERTEX +1.0E+0 0. 0\r\nvertex .0 1 -0\r\nENDLOOP\r\nENDFACET\r\n"
      "ENDSOLID Part With Facet In Its Name",
      "solid\nfacet normal nan -nan(ind) inf\nouter loop\nvertex 0 0 0\nvertex 1 0 1e-400\n"
      "vertex 0 1 0\nendloop\nendfacet\nendsolid",
      "solid a\rfacet normal 0 0 1\router loop\rvertex 0 0 0\rvertex 1 0 0\rvertex 0 1 0\r"
      "endloop\rendfacet\rendsolid a\rsolid b\rendsolid b\r",
  };
  for (const char* text : texts) {
    const TriangleMesh mesh = read_stl(folder.file("a.stl", text));
    ASSERT_EQ(mesh.triangles.size(), 1u) << text;
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}));
  }
}

TEST(StlFile, SeveralSolidsInAFileAreOneMesh) {
  const ScratchFolder folder;
  const std::string one = ascii_stl({one_triangle});
  const TriangleMesh mesh = read_stl(folder.file("a.stl", one + "\n\n" + one));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(StlFile, ARefusalNamesFilePlaceFoundAndExpected) {
  const ScratchFolder folder;
  const std::string good = ascii_stl({one_triangle});
  const auto with = [&](const std::string& old_words, const std::string& new_words) {
    std::string text = good;
    text.replace(text.find(old_words), old_words.size(), new_words);
    return stl_refusal(folder.file("bad.stl", text));
  };
  EXPECT_THAT(with("vertex 1 0 0", "vertex 1,5 0 0"),
              ::testing::AllOf(HasSubstr("bad.stl, line 5"), HasSubstr("found \"1,5\""),
                               HasSubstr("expected a number")));
  EXPECT_THAT(with("vertex 1 0 0", "vertex 1 nan 0"), HasSubstr("not a finite number"));
  EXPECT_THAT(with("vertex 1 0 0", "vertex 1 0 1e400"), HasSubstr("not a finite number"));
  EXPECT_THAT(with("vertex 1 0 0", "vertex 1 0 -1.1e9"), HasSubstr("absurdly large"));
  EXPECT_THAT(with("vertex 1 0 0", "vertex 1 0"), HasSubstr("found \"vertex\""));
  EXPECT_THAT(with("  vertex 1 0 0\n", ""),
              ::testing::AllOf(HasSubstr("found \"endloop\""), HasSubstr("expected \"vertex\"")));
  EXPECT_THAT(with(" endloop", "  vertex 2 2 2\n endloop"), HasSubstr("expected \"endloop\""));
  EXPECT_THAT(with("endsolid part", "\x01\x02"), HasSubstr("found \"?\?\""));
  EXPECT_THAT(with("endsolid part\n", ""), HasSubstr("the file is cut short"));
  EXPECT_THAT(with("solid part", "part"), HasSubstr("starts with \"solid\""));
  EXPECT_THAT(stl_refusal(folder.file("bad.stl", "")), HasSubstr("found 0 bytes"));
  EXPECT_THAT(stl_refusal(folder.file("bad.stl", binary_stl({}))), HasSubstr("holds no triangle"));
  EXPECT_THAT(stl_refusal(folder.file("bad.stl", binary_stl({one_triangle}) + "more")),
              HasSubstr("bytes behind the last triangle"));
  EXPECT_THAT(stl_refusal(folder.path()), HasSubstr("a folder"));
  EXPECT_THAT(stl_refusal(folder.path() / "none.stl"), HasSubstr("there is no such file"));
}

TEST(StlFile, ACoordinateThatIsNoPlaceIsRefusedWithItsTriangle) {
  const ScratchFolder folder;
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), inf, -inf, 1.001e9f, -3e38f}) {
    for (std::size_t k = 0; k < 9; ++k) {
      std::vector<Corners> triangles(7, one_triangle);
      triangles[4][k / 3][k % 3] = bad;
      EXPECT_THAT(stl_refusal(folder.file("bad.stl", binary_stl(triangles))),
                  HasSubstr("bad.stl, triangle 5 of 7"));
    }
  }
}

TEST(StlFile, ALyingTriangleCountTakesNoMemory) {
  const ScratchFolder folder;
  for (const std::uint32_t lie : {2u, 0x66660002u, 0xffffffffu}) {
    std::string bytes = binary_stl({one_triangle});
    std::memcpy(&bytes[80], &lie, sizeof lie);
    const auto path = folder.file("lie.stl", bytes);
    const AllocationMeter meter;
    EXPECT_THAT(stl_refusal(path), HasSubstr(fmt::format("a count of {} triangles", lie)));
    EXPECT_LT(meter.peak(), 64u << 10);
  }
}

TEST(StlFile, ReadingTakesNoMoreThanThreeTimesTheFile) {
  const ScratchFolder folder;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> number(-1, 1);
  std::vector<Corners> soup(100'000);
  for (auto& triangle : soup) {
    for (auto& corner : triangle) {
      for (float& x : corner) x = number(random);
    }
  }
  const auto closed = corners_of(primitive::sphere(1, 400));
  for (const std::string& bytes : {binary_stl(closed), binary_stl(soup), ascii_stl(closed)}) {
    const auto path = folder.file("big.stl", bytes);
    const AllocationMeter meter;
    read_stl(path);
    EXPECT_LT(meter.peak(), 3 * bytes.size());
  }
}

TEST(StlFile, ACutFileIsAlwaysRefused) {
  const ScratchFolder folder;
  const auto triangles = corners_of(primitive::sphere(0.5, 12));
  const std::string binary = binary_stl(triangles), ascii = ascii_stl(triangles);
  std::mt19937 random(20);
  for (int i = 0; i < 300; ++i) {
    const auto cut = [&](std::size_t end) {
      return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
    };
    const std::size_t at = cut(binary.size());
    EXPECT_NE(stl_refusal(folder.file("b.stl", binary.substr(0, at))), "")
        << "binary cut at " << at;
    // Behind the last keyword only the name is cut, which is no loss.
    const std::size_t behind = cut(ascii.rfind("endsolid") + 8);
    EXPECT_NE(stl_refusal(folder.file("a.stl", ascii.substr(0, behind))), "")
        << "ASCII cut at " << behind;
  }
}

TEST(StlFile, RandomDamageGivesAMeshOrARefusalWithinItsMemory) {
  const ScratchFolder folder;
  const auto triangles = corners_of(primitive::sphere(0.5, 8));
  const std::string originals[] = {binary_stl(triangles), ascii_stl(triangles)};
  for (unsigned seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::string bytes = originals[seed % 2];
    const int damage = std::uniform_int_distribution<int>(1, 8)(random);
    for (int i = 0; i < damage; ++i) {
      // Every other file is damaged at its beginning, where the counts and the keywords are.
      const std::size_t range = seed % 4 < 2 ? bytes.size() : std::size_t{120};
      bytes[std::uniform_int_distribution<std::size_t>(0, range - 1)(random)] =
          static_cast<char>(std::uniform_int_distribution<int>(0, 255)(random));
    }
    const auto path = folder.file("damaged.stl", bytes);
    const AllocationMeter meter;
    try {
      const TriangleMesh mesh = read_stl(path);
      ASSERT_FALSE(mesh.triangles.empty());
      for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
          ASSERT_LT(corner, mesh.vertices.size());
          ASSERT_LE(mesh.vertices[corner].cwiseAbs().maxCoeff(), 1e9);
        }
      }
    } catch (const Error& error) {
      ASSERT_THAT(error.what(), HasSubstr("damaged.stl"));
    }
    ASSERT_LT(meter.peak(), 3 * bytes.size() + (64u << 10));
  }
}

}  // namespace
}  // namespace vicinity
