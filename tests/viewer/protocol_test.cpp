// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The messages, held against the offsets that docs/viewer_protocol.md prints.

#include "protocol.h"

#include <gmock/gmock.h>

#include <random>

#include "web/frames.h"
#include "web/handshake.h"
#include "web_client.h"

namespace vicinity::viewer {
namespace {

using viewer_test::bytes_of;
using viewer_test::command;

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  if (offset + sizeof value > bytes.size()) {
    ADD_FAILURE() << "the message ends before " << offset;
    return value;
  }
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST(Protocol, EveryNumberOfASnapshotLiesWhereTheDocumentSays) {
  Snapshot s;
  s.generation = 7;
  s.number = 8;
  s.time_s = 1.5;
  s.ticks = 1000;
  s.skipped = 3;
  s.missed = 4;
  s.refused = 5;
  s.drive = DriveMode::tool;
  s.limiter_mode = 2;
  s.q = AxisVector::Constant(3, 0.25);
  s.qd = AxisVector::Constant(3, -0.5);
  s.output.torque = AxisVector::Constant(3, 2.5);
  s.output.status = Status::outside_field;
  s.output.limiter.limit = DragLimit::force;
  s.output.limiter.status = LimiterStatus::input_stale;
  s.output.limiter.asked = 9;
  s.output.limiter.given = 8;
  s.output.energy = {.drag = 1, .device = 2, .lowest = -3, .passive = false, .unaccounted = 6};
  s.output.counts.points_felt = 70'000;
  s.output.tool.force = {1, 2, 3};
  s.output.tool.moment = {4, 5, 6};
  s.output.master_force = 12;
  s.output.power = 13;
  s.output.reason = {.point = 17,
                     .link = 2,
                     .object = 1,
                     .kind = VoxelKind::neighbour,
                     .rank = 3,
                     .share = 0.5,
                     .distance_m = 0.031,
                     .time_to_contact_s = 0.4};
  s.scale = 0.75;
  s.tool.translation() = Vec3(0.1, 0.2, 0.3);
  s.v_WT = {7, 8, 9};
  s.felt = 14;
  s.lag = 15;
  s.pulled_to = {16, 17, 18};
  s.links.resize(4, Pose::Identity());
  s.links[3].translation() = Vec3(21, 22, 23);
  s.points = {{.mu_e = 30, .force_W = {1, 1, 1}}, {.mu_e = 40, .force_W = {-1, -2, -3}}};
  s.last_second = {.p50_us = 50, .p99_us = 99, .largest_us = 100, .latest_us = 60};
  s.histogram[2] = 77;
  s.recording_s = 4.5;
  const std::string m = *snapshot_message(s);

  EXPECT_EQ(at<std::uint16_t>(m, 0), 3);
  EXPECT_EQ(at<std::uint16_t>(m, 2), 1);
  EXPECT_EQ(at<std::uint32_t>(m, 4), 0u);
  EXPECT_EQ(at<std::uint32_t>(m, 8), 7u);
  EXPECT_EQ(at<std::uint32_t>(m, 12), 8u);
  EXPECT_EQ(at<double>(m, 16), 1.5);
  EXPECT_EQ(at<std::uint64_t>(m, 24), 1000u);
  EXPECT_EQ(at<std::uint64_t>(m, 32), 3u);
  EXPECT_EQ(at<std::uint64_t>(m, 40), 4u);
  EXPECT_EQ(at<std::uint64_t>(m, 48), 5u);
  EXPECT_EQ(at<std::uint16_t>(m, 56), 3);   // joints
  EXPECT_EQ(at<std::uint16_t>(m, 58), 4);   // links
  EXPECT_EQ(at<std::uint16_t>(m, 60), 2);   // points
  EXPECT_EQ(at<std::uint16_t>(m, 62), 20);  // bins
  EXPECT_EQ(at<std::uint8_t>(m, 64), 3);
  EXPECT_EQ(at<std::uint8_t>(m, 65), 1);
  EXPECT_EQ(at<std::uint8_t>(m, 66), 2);
  EXPECT_EQ(at<std::uint8_t>(m, 67), 4);
  EXPECT_EQ(at<std::uint8_t>(m, 68), 2);
  EXPECT_EQ(at<std::uint8_t>(m, 69), 0);
  EXPECT_EQ(at<std::uint16_t>(m, 70), 65'535);
  EXPECT_EQ(at<double>(m, 72), 1);
  EXPECT_EQ(at<double>(m, 80), 2);
  EXPECT_EQ(at<double>(m, 88), -3);
  EXPECT_EQ(at<std::uint64_t>(m, 96), 6u);
  EXPECT_EQ(at<float>(m, 108), 2.f);
  EXPECT_EQ(at<float>(m, 120), 5.f);
  EXPECT_EQ(at<float>(m, 132), 0.2f);
  EXPECT_EQ(at<float>(m, 152), 1.f);  // w of the quaternion
  EXPECT_EQ(at<float>(m, 164), 9.f);
  EXPECT_EQ(at<float>(m, 168), 12.f);
  EXPECT_EQ(at<float>(m, 172), 13.f);
  EXPECT_EQ(at<float>(m, 176), 0.75f);
  EXPECT_EQ(at<float>(m, 180), 9.f);
  EXPECT_EQ(at<float>(m, 184), 8.f);
  EXPECT_EQ(at<float>(m, 188), 14.f);
  EXPECT_EQ(at<float>(m, 192), 15.f);
  EXPECT_EQ(at<float>(m, 196), 40.f);
  EXPECT_EQ(at<float>(m, 208), 18.f);
  EXPECT_EQ(at<std::int32_t>(m, 212), 17);
  EXPECT_EQ(at<std::int32_t>(m, 216), 2);
  EXPECT_EQ(at<std::int32_t>(m, 220), 1);
  EXPECT_EQ(at<std::int32_t>(m, 224), 1);
  EXPECT_EQ(at<std::int32_t>(m, 228), 3);
  EXPECT_EQ(at<float>(m, 232), 0.5f);
  EXPECT_EQ(at<float>(m, 236), 0.031f);
  EXPECT_EQ(at<float>(m, 240), 0.4f);
  EXPECT_EQ(at<float>(m, 244), 50.f);
  EXPECT_EQ(at<float>(m, 248), 99.f);
  EXPECT_EQ(at<float>(m, 252), 100.f);
  EXPECT_EQ(at<float>(m, 256), 60.f);
  EXPECT_EQ(at<float>(m, 260), 4.5f);
  EXPECT_EQ(at<double>(m, 264), 0.25);
  EXPECT_EQ(at<double>(m, 264 + 24), -0.5);
  EXPECT_EQ(at<double>(m, 264 + 48), 2.5);
  const std::size_t links = 264 + 72;
  EXPECT_EQ(at<float>(m, links + 3 * 28 + 4), 22.f);
  const std::size_t mu = links + 4 * 28;
  EXPECT_EQ(at<float>(m, mu + 4), 40.f);
  EXPECT_EQ(at<float>(m, mu + 8 + 12 + 8), -3.f);
  const std::size_t bins = mu + 8 + 24;
  EXPECT_EQ(at<std::uint32_t>(m, bins + 8), 77u);
  EXPECT_EQ(m.size(), bins + 80);
}

TEST(Protocol, DriveComesBackAsItWasSent) {
  const std::string tool = command(
      64, 5,
      bytes_of(std::uint8_t{1}, std::uint8_t{1}, std::uint16_t{0}, 0u, 1., 2., 3., 0., 0., 1., 0.));
  const Drive drive = read_drive(read_command(tool), 3);
  EXPECT_EQ(drive.mode, DriveMode::tool);
  EXPECT_TRUE(drive.orientation_counts);
  EXPECT_EQ(drive.p_WT, Vec3(1, 2, 3));
  EXPECT_EQ(drive.R_WT.z(), 1);
  EXPECT_EQ(drive.R_WT.w(), 0);

  const std::string joints =
      command(64, 0, bytes_of(std::uint8_t{2}, std::uint8_t{0}, std::uint16_t{3}, 0u, 4., 5., 6.));
  EXPECT_EQ(read_drive(read_command(joints), 3).q, Vec3(4, 5, 6));
  EXPECT_THROW(read_drive(read_command(joints), 4), Error);
}

TEST(Protocol, AMessageCutAnywhereIsRefusedAndNeverReadBeyondItsEnd) {
  const std::string whole = command(
      64, 5,
      bytes_of(std::uint8_t{1}, std::uint8_t{1}, std::uint16_t{0}, 0u, 1., 2., 3., 0., 0., 1., 0.));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string cut(whole, 0, size);
    EXPECT_THROW((void)read_drive(read_command(cut), 3), Error) << size << " bytes";
  }
}

TEST(Protocol, AnotherVersionIsRefusedWithBothNumbers) {
  std::string other = command(76, 1);
  other[2] = 9;
  try {
    (void)read_command(other);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("found 9, expected 1"));
  }
}

TEST(Handshake, AnswersTheRfcsOwnExample) {
  EXPECT_EQ(websocket_accept("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

TEST(Frames, MessagesArriveWholeHoweverTheirBytesAreCutUp) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    std::mt19937_64 random(seed);
    const auto up_to = [&](std::uint64_t n) { return random() % (n + 1); };
    std::vector<std::string> sent;
    std::string stream;
    for (std::uint64_t n = 1 + up_to(5); n > 0; --n) {
      std::string message(up_to(3) == 0 ? up_to(70'000) : up_to(300), '\0');
      for (char& c : message) c = static_cast<char>(random());
      sent.push_back(message);
      const std::uint64_t pieces = 1 + up_to(4);
      for (std::uint64_t piece = 0; piece < pieces; ++piece) {
        const std::size_t begin = message.size() * piece / pieces;
        const std::size_t end = message.size() * (piece + 1) / pieces;
        stream +=
            viewer_test::client_frame(piece == 0 ? 2 : 0, message.substr(begin, end - begin),
                                      piece + 1 == pieces, static_cast<std::uint32_t>(random()));
        if (up_to(1) == 1) stream += viewer_test::client_frame(9, "ping");
      }
    }
    FrameReader reader({});
    std::vector<std::string> came;
    for (std::string_view left = stream; !left.empty();) {
      std::string_view piece = left.substr(0, 1 + up_to(2000));
      left.remove_prefix(piece.size());
      while (true) {
        const auto result = reader.read(piece);
        ASSERT_NE(result, FrameReader::Result::refused) << "seed " << seed;
        if (result == FrameReader::Result::need_more) break;
        if (reader.opcode() == Opcode::binary) came.push_back(reader.payload());
        if (reader.opcode() == Opcode::ping) {
          ASSERT_EQ(reader.payload(), "ping");
        }
      }
    }
    ASSERT_EQ(came, sent) << "seed " << seed;
  }
}

TEST(Frames, AFrameIsRefusedByItsHeaderAlone) {
  const auto refused = [](std::string_view bytes) {
    FrameReader reader({.message_bytes = 1000});
    return reader.read(bytes) == FrameReader::Result::refused ? reader.close_code()
                                                              : CloseCode::normal;
  };
  EXPECT_EQ(refused(std::string_view("\x82\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF"
                                     "abcd",
                                     14)),
            CloseCode::too_big);
  EXPECT_EQ(refused(std::string_view("\x82\x05", 2) /* not masked */), CloseCode::protocol_error);
  EXPECT_EQ(refused(std::string_view("\xC2\x81"
                                     "abcd",
                                     6)),
            CloseCode::protocol_error);
  EXPECT_EQ(refused(viewer_test::client_frame(3, "x")), CloseCode::protocol_error);
  EXPECT_EQ(refused(viewer_test::client_frame(0, "x")), CloseCode::protocol_error);
  EXPECT_EQ(refused(viewer_test::client_frame(9, "x", false)), CloseCode::protocol_error);
  EXPECT_EQ(refused(viewer_test::client_frame(9, std::string(126, 'x'))),
            CloseCode::protocol_error);
}

}  // namespace
}  // namespace vicinity::viewer
