// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity export: what other programs read must be what vicinity query says.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <random>
#include <sstream>

#include "program.h"

namespace vicinity::cli_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// The header of an .npy file, read as its format description says.
struct Npy {
  std::string header;
  std::size_t data_at = 0;
  std::string bytes;

  explicit Npy(const std::filesystem::path& path) : bytes(text_of(path)) {
    if (bytes.substr(0, 8) != std::string("\x93NUMPY\x01\x00", 8)) return;
    const auto low = static_cast<unsigned char>(bytes[8]);
    const auto high = static_cast<unsigned char>(bytes[9]);
    const std::size_t length = low + 256u * high;
    header = bytes.substr(10, length);
    data_at = 10 + length;
  }
  template <class Number>
  Number at(std::size_t n) const {
    Number value;
    std::memcpy(&value, bytes.data() + data_at + n * sizeof value, sizeof value);
    return value;
  }
};

struct SmallField : testing::Test {
  Folder folder;
  nlohmann::ordered_json built;
  std::array<int, 3> dims{};
  std::array<double, 3> origin{};

  void build(const std::vector<std::string>& more = {}) {
    folder.write("scene.yaml", small_scene);
    std::vector<std::string> arguments = {"build", "scene.yaml", "-o", "f.vicinity", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Answer answer = folder.run(arguments);
    ASSERT_EQ(answer.code, 0) << answer.err;
    built = answer.json();
    for (int axis = 0; axis < 3; ++axis) {
      dims[axis] = built["dims"][axis];
      origin[axis] = built["origin"][axis];
    }
  }
  // What vicinity query says at the centres of some voxels, drawn by a seed.
  struct Asked {
    std::array<int, 3> voxel;
    nlohmann::ordered_json says;
  };
  std::vector<Asked> ask(int count, unsigned seed) const {
    std::mt19937 random(seed);
    std::vector<Asked> asked;
    std::string lines;
    for (int n = 0; n < count; ++n) {
      Asked one;
      for (int axis = 0; axis < 3; ++axis) {
        one.voxel[axis] = std::uniform_int_distribution(0, dims[axis] - 1)(random);
        lines += std::to_string(origin[axis] + 0.01 * (one.voxel[axis] + 0.5));
        lines += axis < 2 ? "," : "\n";
      }
      asked.push_back(one);
    }
    const Answer answer = folder.run({"query", "f.vicinity", "--json"}, lines);
    EXPECT_EQ(answer.code, 0) << answer.err;
    std::istringstream said(answer.out);
    for (Asked& one : asked) {
      std::string line;
      std::getline(said, line);
      one.says = nlohmann::ordered_json::parse(line);
    }
    return asked;
  }
  std::size_t c_order(const std::array<int, 3>& v) const {
    return (static_cast<std::size_t>(v[0]) * dims[1] + v[1]) * dims[2] + v[2];
  }
};

TEST_F(SmallField, NpyHoldsTheRanksThatQuerySays) {
  build();
  ASSERT_EQ(folder.run({"export", "f.vicinity", "-o", "f.npy"}).code, 0);
  const Npy npy(folder / "f.npy");
  EXPECT_EQ(npy.data_at % 64, 0u);
  EXPECT_THAT(npy.header, HasSubstr("'descr': '<i2'"));
  EXPECT_THAT(npy.header, HasSubstr("'fortran_order': False"));
  EXPECT_THAT(npy.header,
              HasSubstr("'shape': (" + std::to_string(dims[0]) + ", " + std::to_string(dims[1]) +
                        ", " + std::to_string(dims[2]) + ")"));
  EXPECT_EQ(npy.header.back(), '\n');
  ASSERT_EQ(npy.bytes.size(), npy.data_at + 2u * dims[0] * dims[1] * dims[2]);

  const auto beside = nlohmann::json::parse(text_of(folder / "f.json"));
  EXPECT_EQ(beside["origin"], built["origin"]);
  EXPECT_EQ(beside["voxel_size"], built["voxel_size"]);

  constexpr unsigned seed = 7;
  SCOPED_TRACE(seed);
  int kinds_seen = 0;
  for (const auto& [voxel, says] : ask(400, seed)) {
    const std::string kind = says["kind"];
    const int expected = kind == "boundary" ? 0
                         : kind == "inner"  ? -2
                         : kind == "empty"  ? -1
                                            : says["rank"].get<int>();
    EXPECT_EQ(npy.at<std::int16_t>(c_order(voxel)), expected);
    kinds_seen |= 1 << (expected + 2);
  }
  EXPECT_EQ(kinds_seen, 0b111111) << "the sample must hold every kind and rank";

  std::uint64_t boundary = 0;
  for (std::size_t n = 0; n < static_cast<std::size_t>(dims[0] * dims[1] * dims[2]); ++n) {
    boundary += npy.at<std::int16_t>(n) == 0;
  }
  EXPECT_EQ(boundary, built["voxels"]["boundary"]);
}

TEST_F(SmallField, NpyHoldsTheViscositiesThatQuerySays) {
  build();
  ASSERT_EQ(folder.run({"export", "f.vicinity", "-o", "v.npy", "--what", "viscosity"}).code, 0);
  const Npy npy(folder / "v.npy");
  EXPECT_THAT(npy.header, HasSubstr("'descr': '<f4'"));
  for (const auto& [voxel, says] : ask(100, 8)) {
    EXPECT_FLOAT_EQ(npy.at<float>(c_order(voxel)), says["viscosity"].get<float>());
  }
}

TEST_F(SmallField, NpyHoldsTheDistancesThatQuerySays) {
  build({"--shape", "distance"});
  ASSERT_EQ(folder.run({"export", "f.vicinity", "-o", "d.npy", "--what", "distance"}).code, 0);
  const Npy npy(folder / "d.npy");
  int kept = 0;
  for (const auto& [voxel, says] : ask(200, 9)) {
    const float distance = npy.at<float>(c_order(voxel));
    EXPECT_EQ(std::isnan(distance), says["kind"] == "empty");
    if (std::isnan(distance)) continue;
    EXPECT_NEAR(distance, says["distance"].get<float>(), 1e-5);
    ++kept;
  }
  EXPECT_GT(kept, 20);
}

TEST_F(SmallField, ABoxIsACutOutOfTheWhole) {
  build();
  std::string box;
  for (const int voxel : {3, 9}) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!box.empty()) box += ',';
      box += std::to_string(origin[axis] + 0.01 * voxel);
    }
  }
  ASSERT_EQ(folder.run({"export", "f.vicinity", "-o", "whole.npy"}).code, 0);
  ASSERT_EQ(folder.run({"export", "f.vicinity", "-o", "part.npy", "--box", box}).code, 0);
  const Npy whole(folder / "whole.npy"), part(folder / "part.npy");
  EXPECT_THAT(part.header, HasSubstr("(6, 6, 6)"));
  std::size_t n = 0;
  for (int i = 3; i < 9; ++i) {
    for (int j = 3; j < 9; ++j) {
      for (int k = 3; k < 9; ++k, ++n) {
        EXPECT_EQ(part.at<std::int16_t>(n), whole.at<std::int16_t>(c_order({i, j, k})));
      }
    }
  }
  const auto beside = nlohmann::json::parse(text_of(folder / "part.json"));
  EXPECT_NEAR(beside["origin"][0], origin[0] + 0.03, 1e-9);
}

TEST_F(SmallField, VtiHoldsTheSameValuesWithXFastest) {
  build();
  ASSERT_EQ(folder.run({"export", "f.vicinity", "-o", "f.npy"}).code, 0);
  ASSERT_EQ(folder.run({"export", "f.vicinity", "-o", "f.vti"}).code, 0);
  const Npy npy(folder / "f.npy");
  const std::string vti = text_of(folder / "f.vti");
  EXPECT_THAT(vti.substr(0, 600), HasSubstr("WholeExtent=\"0 " + std::to_string(dims[0]) + " 0 "));
  const std::size_t voxels = static_cast<std::size_t>(dims[0] * dims[1] * dims[2]);
  const std::size_t mark = vti.find("<AppendedData encoding=\"raw\">");
  ASSERT_NE(mark, std::string::npos);
  const std::size_t at = vti.find('_', mark) + 1;
  std::uint64_t length = 0;
  std::memcpy(&length, vti.data() + at, sizeof length);
  ASSERT_EQ(length, 2 * voxels);
  std::size_t n = 0;
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i, ++n) {
        std::int16_t value;
        std::memcpy(&value, vti.data() + at + 8 + 2 * n, sizeof value);
        ASSERT_EQ(value, npy.at<std::int16_t>(c_order({i, j, k})));
      }
    }
  }
  EXPECT_THAT(vti.substr(at + 8 + length), HasSubstr("</VTKFile>"));
}

TEST_F(SmallField, VdbIsWrittenWholeOrRefusedWithASentence) {
  build();
  const Answer answer = folder.run({"export", "f.vicinity", "-o", "f.vdb"});
  if (answer.code == 2) {
    EXPECT_THAT(answer.err, HasSubstr("without OpenVDB"));
    EXPECT_THAT(folder.files(), ElementsAre("f.vicinity", "scene.yaml"));
    return;
  }
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(folder.files(), ElementsAre("f.vdb", "f.vicinity", "scene.yaml"));
  const std::string vdb = text_of(folder / "f.vdb");
  EXPECT_EQ(vdb.substr(0, 4), std::string("\x20\x42\x44\x56"));  // OpenVDB's magic number
  EXPECT_THAT(vdb, HasSubstr("viscosity"));
}

// Where the disk is full, and every write of more than some bytes fails.
TEST_F(SmallField, VdbThatTheDiskDoesNotTakeLeavesTheEarlierOne) {
  build();
  const Answer first = folder.run({"export", "f.vicinity", "-o", "f.vdb"});
  if (first.err.find("this program was built without OpenVDB") != std::string::npos) {
    GTEST_SKIP() << "built without OpenVDB";
  }
  ASSERT_EQ(first.code, 0) << first.err;
  const std::string whole = text_of(folder / "f.vdb");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit full{.rlim_cur = whole.size() / 2, .rlim_max = before.rlim_max};
  const auto on_signal = std::signal(SIGXFSZ, SIG_IGN);  // children take both over
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  const Answer answer = folder.run({"export", "f.vicinity", "-o", "f.vdb"});
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, on_signal);
  EXPECT_EQ(answer.code, 2) << answer.out;
  EXPECT_THAT(answer.err, HasSubstr("f.vdb: cannot be written"));
  EXPECT_THAT(folder.files(), ElementsAre("f.vdb", "f.vicinity", "scene.yaml"));
  EXPECT_EQ(text_of(folder / "f.vdb"), whole);
}

TEST_F(SmallField, AnAbsurdSizeIsRefusedBeforeAnythingIsWritten) {
  build({"--bounds", "-45,-45,-45,45,45,45"});
  const Answer answer = folder.run({"export", "f.vicinity", "-o", "f.npy"});
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, HasSubstr("TB"));
  EXPECT_THAT(answer.err, HasSubstr("--box"));
  EXPECT_THAT(folder.files(), ElementsAre("f.vicinity", "scene.yaml"));
}

}  // namespace
}  // namespace vicinity::cli_test
