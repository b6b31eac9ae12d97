// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// ROS 2's messages: the bytes and hashes that ROS 2 itself has for them, and what becomes of bytes
// that are none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "ros2/cdr.h"
#include "ros2/schema.h"
#include "ros2/sha256.h"
#include "ros2/shown_messages.h"
#include "viscosity/seeds.h"

namespace vicinity::ros2 {
namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes_of(const std::vector<int>& numbers) {
  Bytes bytes;
  for (const int number : numbers) bytes.push_back(static_cast<std::byte>(number));
  return bytes;
}

template <class Message>
std::string hash_of() {
  return type_hash(Describer::of<Message>());
}

// As rosidl generates them into the headers of these messages (TYPE_HASH in *__struct.h), Jazzy.
TEST(TypeHash, IsTheOneThatRos2HasForTheMessage) {
  EXPECT_EQ(hash_of<JointState>(),
            "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e");
  EXPECT_EQ(hash_of<WrenchStamped>(),
            "RIHS01_8dc3deaf06b2ab281f9f9a742a8961c328ca7cec16e3fd6586d3a5c83fa78f77");
  EXPECT_EQ(hash_of<MarkerArray>(),
            "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf");
  EXPECT_EQ(hash_of<DiagnosticArray>(),
            "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e");
  EXPECT_EQ(hash_of<PointCloud2>(),
            "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5");
  EXPECT_EQ(hash_of<Float64>(),
            "RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a");
  EXPECT_EQ(hash_of<TFMessage>(),
            "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087");
}

TEST(TypeHash, RestsOnSha256AsTheStandardHasIt) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Schema, NamesTheTypesAsRos2DoesOnTheWireAndInFiles) {
  EXPECT_EQ(dds_type_name(JointState::type), "sensor_msgs::msg::dds_::JointState_");
  EXPECT_EQ(schema_text(Describer::of<JointState>()),
            "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
            "float64[] effort\n" +
                std::string(80, '=') +
                "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" +
                std::string(80, '=') +
                "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n");
}

// Laid out by hand after the rules of plain CDR.
const std::vector<int> joint_state_by_hand = {
    0, 1, 0, 0,                                    // little-endian
    1, 0, 0, 0, 2,   0,   0,    0,                 // stamp
    2, 0, 0, 0, 'w', 0,   0,    0,                 // frame, 2 bytes to a multiple of 4
    2, 0, 0, 0,                                    // two names
    2, 0, 0, 0, 'a', 0,   0,    0,                 // "a", 2 bytes
    5, 0, 0, 0, 'b', 'c', 'd',  'e',  0, 0, 0, 0,  // "bcde", 3 bytes
    1, 0, 0, 0, 0,   0,   0,    0,                 // one position, 4 bytes to a multiple of 8
    0, 0, 0, 0, 0,   0,   0xF0, 0x3F,              // 1.0
    0, 0, 0, 0, 0,   0,   0,    0};                // no velocity, no effort

JointState small_state() {
  JointState state;
  state.header = {{1, 2}, "w"};
  state.name = {"a", "bcde"};
  state.position = {1.0};
  return state;
}

TEST(Cdr, LaysAMessageOutAsTheRulesSay) {
  Bytes bytes;
  write_cdr(small_state(), bytes);
  EXPECT_THAT(bytes, testing::ElementsAreArray(bytes_of(joint_state_by_hand)));
}

TEST(Cdr, ReadsWhatABigEndianSenderSends) {
  Float64 said;
  ASSERT_TRUE(read_cdr(bytes_of({0, 0, 0, 0, 0x3F, 0xF8, 0, 0, 0, 0, 0, 0}), said));
  EXPECT_EQ(said.data, 1.5);
}

MarkerArray random_markers(std::mt19937& random) {
  MarkerArray array;
  array.markers.resize(static_cast<std::size_t>(test::whole(random, 0, 3)));
  for (Marker& marker : array.markers) {
    marker.ns = std::string(static_cast<std::size_t>(test::whole(random, 0, 9)), 'n');
    marker.id = test::whole(random, -9, 9);
    marker.scale.y = test::real(random, -1, 1);
    marker.frame_locked = test::whole(random, 0, 1) == 1;
    marker.points.resize(static_cast<std::size_t>(test::whole(random, 0, 5)), {1, 2, 3});
    marker.colors.resize(static_cast<std::size_t>(test::whole(random, 0, 5)));
    marker.mesh_file.data.resize(static_cast<std::size_t>(test::whole(random, 0, 5)), 7);
    marker.text = "text";
  }
  return array;
}

// A message is its bytes: what is written again is the same.
TEST(Cdr, GivesBackWhatWasWritten) {
  test::for_each_seed(50, [](std::mt19937& random) {
    Bytes bytes, again;
    write_cdr(random_markers(random), bytes);
    MarkerArray said;
    ASSERT_TRUE(read_cdr(bytes, said));
    write_cdr(said, again);
    EXPECT_EQ(bytes, again);
  });
}

TEST(Cdr, RefusesEveryMessageThatIsCutShort) {
  Bytes bytes;
  write_cdr(small_state(), bytes);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    JointState said;
    EXPECT_FALSE(read_cdr(std::span(bytes).first(length), said)) << length;
  }
}

TEST(Cdr, SurvivesAnyBytes) {
  test::for_each_seed(2000, [](std::mt19937& random) {
    Bytes bytes;
    write_cdr(random_markers(random), bytes);
    for (int n = test::whole(random, 1, 8); n > 0; --n) {
      const int place = test::whole(random, 0, static_cast<int>(bytes.size()) - 1);
      bytes[static_cast<std::size_t>(place)] = static_cast<std::byte>(test::whole(random, 0, 255));
    }
    MarkerArray markers;
    (void)read_cdr(bytes, markers);  // true or false, but it comes back
    JointState state;
    (void)read_cdr(bytes, state);
    EXPECT_LE(markers.markers.size(), bytes.size());
  });
}

}  // namespace
}  // namespace vicinity::ros2
