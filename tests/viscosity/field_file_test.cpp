// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/field_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>

#include "dense_field.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

using test::DenseField;

class FieldFile : public ::testing::Test {
 protected:
  FieldFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "vicinity-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~FieldFile() override { std::filesystem::remove_all(folder_); }

  static std::string content(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void write(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  std::size_t files_in_folder() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), {}));
  }
  static ViscosityField some_field(unsigned seed) {
    std::mt19937 random(seed);
    return DenseField::random(random, true).sparse();
  }

  std::filesystem::path folder_;
};

TEST_F(FieldFile, HoldsTheImageByteForByte) {
  const ViscosityField field = some_field(1);
  const auto path = folder_ / "a.vicinity";
  save_field(field, path);
  const ViscosityField opened = open_field(path);
  EXPECT_TRUE(std::ranges::equal(opened.image(), field.image()));
  const std::string bytes = content(path);
  EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(bytes)), field.image()));
  save_field(opened, folder_ / "b.vicinity");
  EXPECT_EQ(content(folder_ / "b.vicinity"), bytes);
  EXPECT_EQ(files_in_folder(), 2u);
}

TEST_F(FieldFile, ReplacingAFileLeavesOpenFieldsAlone) {
  const auto path = folder_ / "a.vicinity";
  const ViscosityField old_field = some_field(1);
  save_field(old_field, path);
  const ViscosityField opened = open_field(path);
  save_field(some_field(2), path);
  EXPECT_TRUE(std::ranges::equal(opened.image(), old_field.image()));
  EXPECT_FALSE(std::ranges::equal(open_field(path).image(), old_field.image()));
}

TEST_F(FieldFile, WhereItCannotBeWrittenNothingChanges) {
  const ViscosityField field = some_field(1);
  EXPECT_THROW(save_field(field, folder_ / "missing" / "a.vicinity"), Error);
  std::filesystem::create_directory(folder_ / "taken");
  EXPECT_THROW(save_field(field, folder_ / "taken"), Error);
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(FieldFile, ASymbolicLinkStaysOneAndWhatItLeadsToIsReplaced) {
  namespace fs = std::filesystem;
  fs::create_directory(folder_ / "far");
  write(folder_ / "far" / "a.vicinity", "old");
  fs::create_symlink("far/a.vicinity", folder_ / "near");
  fs::create_symlink("near", folder_ / "link");
  fs::create_symlink("far/new.vicinity", folder_ / "to_nothing");
  for (const char* link : {"link", "to_nothing"}) {
    save_field(some_field(1), folder_ / link);
    EXPECT_TRUE(fs::is_symlink(folder_ / link)) << link;
    EXPECT_TRUE(std::ranges::equal(open_field(folder_ / link).image(), some_field(1).image()));
  }
  EXPECT_TRUE(fs::is_symlink(folder_ / "near"));
  fs::create_symlink("loop", folder_ / "loop");
  EXPECT_THROW(save_field(some_field(1), folder_ / "loop"), Error);
  EXPECT_EQ(files_in_folder(), 5u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "far"), {}), 2);
}

TEST_F(FieldFile, APipeIsNotReplaced) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("pipe", folder_ / "link");
  EXPECT_THROW(save_field(some_field(1), folder_ / "pipe"), Error);
  EXPECT_THROW(save_field(some_field(1), folder_ / "link"), Error);
  EXPECT_THROW(save_field(some_field(1), ""), Error);
  EXPECT_TRUE(std::filesystem::is_fifo(folder_ / "pipe"));
  EXPECT_EQ(files_in_folder(), 2u);
}

TEST_F(FieldFile, AFullDiskLeavesTheOldFileAndNothingElse) {
  const auto path = folder_ / "a.vicinity";
  write(path, "old");
  const ViscosityField field = some_field(1);
  // A limit on file size fails a write half way, as a full disk does.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small = {field.image().size() / 2, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(save_field(field, path), Error);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(content(path), "old");
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(FieldFile, OtherFilesAreRefusedWithASentence) {
  const auto path = folder_ / "a.vicinity";
  EXPECT_THROW(open_field(path), Error);
  EXPECT_THROW(open_field(folder_), Error);
  EXPECT_THROW(open_field("/dev/null"), Error);
  for (const std::string& bytes : {std::string(), std::string("solid cube\n"),
                                   std::string("VICINITY"), std::string(1000, '\0')}) {
    write(path, bytes);
    EXPECT_THROW(open_field(path), Error);
  }
}

TEST_F(FieldFile, ATruncatedFileIsRefused) {
  const auto path = folder_ / "a.vicinity";
  save_field(some_field(3), path);
  const std::string bytes = content(path);
  for (const std::size_t size : {bytes.size() - 1, bytes.size() / 2, std::size_t{321},
                                 std::size_t{320}, std::size_t{319}, std::size_t{1}}) {
    write(path, bytes.substr(0, size));
    EXPECT_THROW(open_field(path), Error) << size;
  }
}

TEST_F(FieldFile, AFileOfManyHolesIsRefusedAtOnce) {
  const auto path = folder_ / "a.vicinity";
  save_field(some_field(3), path);
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40);
  EXPECT_THROW(open_field(path), Error);
}

}  // namespace
}  // namespace vicinity
