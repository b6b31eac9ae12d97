// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A field that goes to another machine: cut by its content, fetched as far as it differs, whole or
// not at all.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "cli/small_arm.h"
#include "field_follower.h"
#include "field_in_use.h"
#include "field_sharer.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/field_image.h"
#include "viscosity/seeds.h"

namespace vicinity::bridge {
namespace {

using Bytes = std::vector<std::byte>;

Bytes random_bytes(std::mt19937& random, int size) {
  Bytes bytes(static_cast<std::size_t>(size));
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

std::set<std::uint64_t> checksums(const Bytes& file) {
  std::set<std::uint64_t> all;
  for (const Chunk& chunk : chunks_of(file)) all.insert(chunk.checksum);
  return all;
}

TEST(Chunks, AreTheWholeFileInOrderAndWithinTheirLimits) {
  test::for_each_seed(30, [](std::mt19937& random) {
    Bytes file = random_bytes(random, test::whole(random, 0, 300'000));
    // Long runs of one value, as fields have them.
    const int run = test::whole(random, 0, static_cast<int>(file.size()));
    std::fill_n(file.begin(), run, std::byte{7});
    std::uint64_t end = 0;
    for (const Chunk& chunk : chunks_of(file)) {
      ASSERT_EQ(chunk.offset, end);
      end += chunk.size;
      ASSERT_TRUE(chunk.size >= smallest_chunk || end == file.size());
      ASSERT_LE(chunk.size, largest_chunk);
      ASSERT_EQ(chunk.checksum, checksum_of(std::span(file).subspan(chunk.offset, chunk.size)));
    }
    EXPECT_EQ(end, file.size());
  });
}

TEST(Chunks, AnInsertionChangesOnlyThoseAroundIt) {
  test::for_each_seed(30, [](std::mt19937& random) {
    Bytes file = random_bytes(random, 500'000);
    const std::set<std::uint64_t> before = checksums(file);
    const Bytes more = random_bytes(random, test::whole(random, 1, 5000));
    file.insert(file.begin() + test::whole(random, 0, 500'000), more.begin(), more.end());
    int changed = 0;
    for (const std::uint64_t checksum : checksums(file))
      changed += before.contains(checksum) ? 0 : 1;
    EXPECT_GE(changed, 1);
    EXPECT_LE(changed, 8) << "of " << before.size();
  });
}

constexpr const char* two_blocks = R"(
voxel_size: 0.004
bounds: [[-0.5, -0.5, -0.3], [1.1, 0.5, 0.3]]
objects:
  - name: block
    primitive: {box: {size: [0.2, 0.1, 0.1]}}
  - name: wheel
    primitive: {torus: {radius: 0.15, tube_radius: 0.03}}
    pose: {xyz: [0.75, 0, 0], rpy: [0.3, 0.2, 0.1]}
)";

// One participant for both sides: what goes between them is bytes all the same.
class SharedField : public testing::Test {
 protected:
  SharedField()
      : folder_(mkdtemp(name_.data())),
        participant_({.domain = 100 + static_cast<std::uint32_t>(getpid()) % 100,
                      .configuration = {},
                      .name_space = {}}) {
    write_scene(two_blocks);
    share();
  }
  ~SharedField() override { std::filesystem::remove_all(folder_); }

  void write_scene(const std::string& text) const { std::ofstream(folder_ / "scene.yaml") << text; }
  void share() {
    sharer_.reset();
    input_ = std::make_unique<WatchedInput>(folder_ / "scene.yaml");
    sharer_ = std::make_unique<FieldSharer>(participant_, "/cell", *input_, input_->field(), say());
  }
  void follow() {
    follower_ = std::make_unique<FieldFollower>(participant_, "/cell", copy(), say());
  }
  // Both sides, until the follower has a field, or gives up.
  std::optional<ViscosityField> wait_for_field() {
    for (int n = 0; n < 2000; ++n) {
      (void)sharer_->step(0);
      if (auto field = follower_->step(0.005)) return field;
    }
    return {};
  }
  std::filesystem::path copy() const { return folder_ / "copy.vicinity"; }
  std::filesystem::path part() const { return folder_ / "copy.vicinity.part"; }
  Say say() {
    return [this](const std::string& sentence) { said_ << sentence << '\n'; };
  }
  static Bytes bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
  }
  static Bytes built(const std::filesystem::path& scene) {
    WatchedInput input(scene);
    const ViscosityField field = input.field();
    return {field.image().begin(), field.image().end()};
  }
  Bytes built() const { return built(folder_ / "scene.yaml"); }

  std::string name_ = (std::filesystem::temp_directory_path() / "vicinity_field_XXXXXX").string();
  std::filesystem::path folder_;
  std::ostringstream said_;
  dds::Participant participant_;
  std::unique_ptr<WatchedInput> input_;
  std::unique_ptr<FieldSharer> sharer_;
  std::unique_ptr<FieldFollower> follower_;
};

TEST_F(SharedField, ArrivesByteForByte) {
  follow();
  EXPECT_FALSE(follower_->open_copy());
  EXPECT_EQ(follower_->standing().words, "no field");
  const auto field = wait_for_field();
  ASSERT_TRUE(field) << said_.str();
  EXPECT_EQ(bytes_of(copy()), built());
  EXPECT_FALSE(std::filesystem::exists(part()));
  EXPECT_EQ(follower_->standing().words, "as shared");
  EXPECT_EQ(follower_->checksum(), sharer_->checksum());
}

TEST_F(SharedField, OfAChangeOnlyWhatDiffersIsFetched) {
  follow();
  ASSERT_TRUE(wait_for_field()) << said_.str();
  const Bytes before = built();
  const std::uint64_t fetched_before = follower_->traffic().chunks;
  std::string moved = two_blocks;
  moved.replace(moved.find("0.75"), 4, "0.73");
  write_scene(moved);
  ASSERT_TRUE(wait_for_field()) << said_.str();
  const Bytes after = built();
  EXPECT_EQ(bytes_of(copy()), after);
  std::set<std::uint64_t> differ = checksums(after);
  for (const std::uint64_t same : checksums(before)) differ.erase(same);
  EXPECT_EQ(follower_->traffic().chunks - fetched_before, differ.size());
  EXPECT_LT(differ.size(), checksums(after).size()) << "nothing was the same";
  // A scene that is broken changes nothing, and is said.
  write_scene("objects: [");
  for (int n = 0; n < 200 && sharer_->standing().level == ros2::DiagnosticStatus::ok; ++n) {
    EXPECT_FALSE(sharer_->step(0.01));
  }
  EXPECT_THAT(said_.str(), testing::HasSubstr("the field stays as it was"));
  EXPECT_EQ(bytes_of(copy()), after);
  write_scene(two_blocks);
  ASSERT_TRUE(wait_for_field()) << said_.str();
  EXPECT_EQ(bytes_of(copy()), before);
}

TEST_F(SharedField, AChunkThatIsNotWholeIsRefused) {
  // Somebody else answers first, with the right checksum and the wrong bytes.
  const dds_entity_t liar =
      participant_.writer<FieldChunk>(field_topic<FieldChunk>("/cell"), chunk_quality);
  follow();
  const Bytes file = built();
  dds::Sample bytes;
  for (int n = 0; n < 100 && !std::filesystem::exists(part()); ++n) (void)follower_->step(0.01);
  for (const Chunk& chunk : chunks_of(file)) {
    ASSERT_TRUE(
        dds::send(liar, FieldChunk{chunk.checksum, std::vector<std::uint8_t>(chunk.size)}, bytes));
    (void)follower_->step(0.005);
  }
  ASSERT_TRUE(wait_for_field()) << said_.str();
  EXPECT_GT(follower_->traffic().refused, 0u);
  EXPECT_EQ(bytes_of(copy()), file);
}

TEST_F(SharedField, ADamagedCopyIsRefusedAndMendedFromWhatIsWhole) {
  follow();
  ASSERT_TRUE(wait_for_field()) << said_.str();
  const Bytes file = built();
  {
    std::fstream damage(copy(), std::ios::in | std::ios::out | std::ios::binary);
    damage.seekp(static_cast<std::streamoff>(file.size() / 2));
    damage << "damage";
  }
  follow();
  EXPECT_FALSE(follower_->open_copy());
  EXPECT_THAT(said_.str(), testing::HasSubstr("it is fetched anew"));
  ASSERT_TRUE(wait_for_field()) << said_.str();
  EXPECT_LE(follower_->traffic().chunks, 3u);
  EXPECT_EQ(bytes_of(copy()), file);
}

TEST_F(SharedField, ACopyOfAnotherFieldIsFeltUntilTheSharedOneIsHere) {
  {
    std::ofstream(folder_ / "other.yaml")
        << "objects: [{name: ball, primitive: {sphere: {radius: 0.1}}}]";
    WatchedInput other(folder_ / "other.yaml");
    save_field(other.field(), copy());
  }
  follow();
  EXPECT_TRUE(follower_->open_copy());
  ASSERT_TRUE(wait_for_field()) << said_.str();
  EXPECT_THAT(said_.str(), testing::HasSubstr("holds another field than is shared"));
  EXPECT_EQ(bytes_of(copy()), built());
}

// Both sides may end at any moment, and go on where they were.
TEST_F(SharedField, WhatWasFetchedBeforeTheEndIsNotFetchedAgain) {
  follow();
  const std::size_t all = checksums(built()).size();
  while (follower_->traffic().chunks < all / 2) {
    (void)sharer_->step(0);
    ASSERT_FALSE(follower_->step(0.002));
  }
  const std::uint64_t first = follower_->traffic().chunks;
  follower_.reset();
  sharer_.reset();
  follow();
  EXPECT_FALSE(follower_->open_copy());
  share();
  ASSERT_TRUE(wait_for_field()) << said_.str();
  EXPECT_EQ(follower_->traffic().chunks, all - first);
  EXPECT_EQ(bytes_of(copy()), built());
  // And once more, from the copy alone.
  sharer_.reset();
  follow();
  ASSERT_TRUE(follower_->open_copy());
  EXPECT_EQ(follower_->checksum(), checksum_of(built()));
}

// What passes is no reason to give a field up for ever.
TEST_F(SharedField, ArrivesWhereNoMoreFilesMayBeOpen) {
  follow();
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  for (int n = 0; n < 2000 && !std::filesystem::exists(part()); ++n) {
    (void)sharer_->step(0);
    ASSERT_FALSE(follower_->step(0.001));
  }
  const rlimit full{.rlim_cur = 3, .rlim_max = before.rlim_max};  // those that are open stay
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &full), 0);
  const auto field = wait_for_field();
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  ASSERT_TRUE(field) << said_.str();
  EXPECT_EQ(bytes_of(copy()), built());
}

// As scp and rsync --inplace write: the field that is felt is another.
TEST_F(SharedField, AFieldFileThatIsCutAndWrittenAnewInPlaceIsNoHarm) {
  const std::filesystem::path file = folder_ / "field.vicinity";
  save_field(WatchedInput(folder_ / "scene.yaml").field(), file);
  WatchedInput input(file);
  const ViscosityField field = input.field();
  const Bytes whole = bytes_of(file);
  std::filesystem::resize_file(file, 100);
  EXPECT_TRUE(std::ranges::equal(field.image(), whole));
  for (int n = 0; n < 2; ++n) (void)input.changed();
  EXPECT_THROW((void)input.field(), Error);
  EXPECT_FALSE(input.changed()) << "it was looked at";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(whole.data()),
             static_cast<std::streamsize>(whole.size()));
  (void)input.changed();
  EXPECT_TRUE(input.changed());
  EXPECT_TRUE(std::ranges::equal(input.field().image(), whole));
}

TEST_F(SharedField, SurvivesAnyManifest) {
  follow();
  const dds_entity_t liar =
      participant_.writer<FieldManifest>(field_topic<FieldManifest>("/cell"), manifest_quality);
  dds::Sample bytes;
  test::for_each_seed(40, [&](std::mt19937& random) {
    FieldManifest manifest;
    manifest.checksum = random();
    for (int n = test::whole(random, 0, 20); n > 0; --n) manifest.chunks.push_back(random());
    for (int n = test::whole(random, 0, 20); n > 0; --n) {
      manifest.sizes.push_back(static_cast<std::uint32_t>(random() % 70'000));
    }
    ASSERT_TRUE(dds::send(liar, manifest, bytes));
    EXPECT_FALSE(follower_->step(0.001));
  });
  share();  // whoever speaks last is believed
  ASSERT_TRUE(wait_for_field()) << said_.str();
  EXPECT_EQ(bytes_of(copy()), built());
}

TEST(FieldInUse, OneThatCannotBeFeltIsSaidOnceAndGone) {
  cli::Arm arm;
  arm.robot = parse_urdf(cli_test::small_arm, "the small arm").robot;
  arm.points = sample_body_points(arm.robot, {});
  arm.teleoperation.longest_jump_m = -1;
  Scene scene;
  scene.voxel_size = 0.05;
  scene.objects.push_back({.name = "block", .shape = primitive::box({0.2, 0.1, 0.1})});
  FieldInUse in_use(arm);
  EXPECT_THROW(in_use.offer(build_field(scene).field), Error);
  EXPECT_NO_THROW(in_use.hand_over());
}

// Answers name objects of the field that they are about, also while it changes.
TEST(FieldInUse, GivesEveryAnswerTheNamesOfItsOwnField) {
  cli::Arm arm;
  arm.robot = parse_urdf(cli_test::small_arm, "the small arm").robot;
  arm.points = sample_body_points(arm.robot, {});
  const auto field_named = [&](const std::string& name) {
    std::string path = (std::filesystem::temp_directory_path() / "vicinity_named_XXXXXX").string();
    const std::filesystem::path folder = mkdtemp(path.data());
    std::ofstream(folder / "s.yaml")
        << "objects: [{name: " << name << ", primitive: {sphere: {radius: 0.1}}}]";
    const ViscosityField field = WatchedInput(folder / "s.yaml").field();
    std::filesystem::remove_all(folder);
    return field;
  };
  FieldInUse in_use(arm);
  ArmSample sample;
  sample.heard = Heard::state;
  sample.q = sample.qd = AxisVector::Zero(3);
  const auto answer_at = [&](double time_s) {
    sample.time_s = time_s;
    EXPECT_TRUE(in_use.loop().give(sample));
    Answer answer;
    do {
      EXPECT_TRUE(in_use.loop().take(answer, 10'000'000'000));
    } while (answer.sample.time_s != time_s || answer.sample.heard == Heard::silence ||
             answer.sample.heard == Heard::nothing_yet);
    return answer;
  };
  EXPECT_EQ(answer_at(0.001).sample.heard, Heard::no_field);
  in_use.offer(field_named("first"));
  const Answer first = answer_at(0.002);
  EXPECT_EQ(in_use.objects(first), std::vector<std::string>{"first"});
  in_use.offer(field_named("second"));
  in_use.offer(field_named("never"));  // until the second is taken, the newest waits
  in_use.offer(field_named("third"));
  const Answer second = answer_at(0.003);
  EXPECT_EQ(in_use.objects(second), std::vector<std::string>{"second"});
  in_use.hand_over();
  const Answer third = answer_at(0.004);
  EXPECT_EQ(in_use.objects(third), std::vector<std::string>{"third"});
  EXPECT_EQ(in_use.objects(first), std::vector<std::string>{"first"});
  EXPECT_FALSE(in_use.field(first)) << "it is kept for ever";
  EXPECT_TRUE(in_use.field(third));
}

}  // namespace
}  // namespace vicinity::bridge
