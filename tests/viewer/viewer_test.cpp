// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What a page sees and does: against the field itself, `vicinity query` and `vicinity replay`.

#include "viewer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "cli/small_arm.h"
#include "commands/query.h"
#include "commands/replay.h"
#include "served.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/mesh/stl_file.h"
#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::viewer_test {
namespace {

using testing::HasSubstr;

constexpr std::size_t joints = 3;

// A snapshot as the document lays it out.
struct Seen {
  explicit Seen(const PageClient::Message& of) : message(of) {}
  template <class T>
  T at(std::size_t offset) const {
    return message.number<T>(offset);
  }
  double q(std::size_t c) const { return at<double>(264 + 8 * c); }
  double qd(std::size_t c) const { return at<double>(264 + 8 * (joints + c)); }
  double tau(std::size_t c) const { return at<double>(264 + 8 * (2 * joints + c)); }
  std::size_t links() const { return at<std::uint16_t>(58); }
  std::size_t points() const { return at<std::uint16_t>(60); }
  std::size_t mu_at() const { return 264 + 24 * joints + 28 * links(); }
  float mu(std::size_t n) const { return at<float>(mu_at() + 4 * n); }
  std::uint8_t status() const { return at<std::uint8_t>(64); }
  std::uint64_t ticks() const { return at<std::uint64_t>(24); }
  PageClient::Message message;
};

std::string drive_joints(double turn, double bend, double slide) {
  return command(
      64, 0, bytes_of(std::uint8_t{2}, std::uint8_t{0}, std::uint16_t{3}, 0u, turn, bend, slide));
}

std::optional<Seen> next_snapshot(PageClient& page) {
  const auto message = page.next_of(3);
  return message ? std::optional<Seen>(*message) : std::nullopt;
}

// A snapshot of a moment at which the arm moves through a layer, and its tick was on time.
std::optional<Seen> felt_snapshot(PageClient& page) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  double turn = 0.9;
  while (std::chrono::steady_clock::now() < end) {
    turn = turn > 0 ? -0.4 : 0.9;
    page.send(drive_joints(turn, 0.05, 0));
    for (int n = 0; n < 150; ++n) {
      const auto seen = next_snapshot(page);
      if (!seen) return {};
      const double torque =
          std::abs(seen->tau(0)) + std::abs(seen->tau(1)) + std::abs(seen->tau(2));
      if (seen->status() == 0 && torque > 1e-3) return seen;
    }
  }
  return {};
}

TEST(Viewer, SaysFirstWhatThereIs) {
  Served served;
  PageClient page(served.port());
  const auto first = page.next();
  ASSERT_TRUE(first);
  ASSERT_EQ(first->type(), 1);
  const auto hello = json_of(*first);
  EXPECT_EQ(hello["protocol"], 1);
  EXPECT_EQ(hello["field"]["objects"][0]["name"], served.field().objects()[0].name);
  EXPECT_EQ(hello["field"]["dims"][0], served.field().workspace().dims.i);
  EXPECT_EQ(hello["robot"]["coordinates"][1]["name"], "bend");
  EXPECT_EQ(hello["robot"]["coordinates"][1]["upper"], 2.0);
  EXPECT_TRUE(hello["robot"]["coordinates"][0]["upper"].is_null());
  EXPECT_EQ(hello["scene"]["scene"]["objects"][1]["name"], "ball");
  const auto second = page.next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->type(), 2);
  EXPECT_EQ(second->number<std::uint32_t>(8), 900u);
}

TEST(Viewer, DragAppearsAndReadsAsQueryAndReplayDoForThatPose) {
  Served served;
  PageClient page(served.port());
  const auto points = page.next_of(2);
  ASSERT_TRUE(points);
  const auto seen = felt_snapshot(page);
  ASSERT_TRUE(seen) << "no drag was felt in a minute";

  // Every point's viscosity is what `vicinity query` says at its place.
  save_field(served.field(), served.folder().path() / "f.vicinity");
  ForwardKinematics kinematics(served.robot());
  const double q[] = {seen->q(0), seen->q(1), seen->q(2)};
  const double rest[] = {0, 0, 0};
  kinematics.update(q, rest, cli_test::small_arm_X_WB());
  const std::size_t n = seen->points();
  ASSERT_EQ(n, 900u);
  std::size_t felt = 0, near_a_face = 0;
  for (std::size_t p = 0; p < n; ++p) {
    const auto link = points->number<std::uint32_t>(16 + 4 * p);
    Vec3 p_LR;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p_LR[static_cast<Eigen::Index>(axis)] =
          static_cast<double>(points->number<float>(16 + 4 * n + 4 * (3 * p + axis)));
    }
    const Vec3 p_WR = kinematics.X_WL(link) * p_LR;
    const Vec3 grid = served.field().workspace().to_grid(p_WR);
    const double to_face = (grid - grid.array().round().matrix()).cwiseAbs().minCoeff();
    if (to_face < 1e-4) {  // single precision may put it into either voxel
      ++near_a_face;
      continue;
    }
    cli::QueryOptions query;
    query.field = served.folder().path() / "f.vicinity";
    query.point = {p_WR.x(), p_WR.y(), p_WR.z()};
    query.json = true;
    if (seen->mu(p) == 0 && p % 30 != 0) continue;  // of the many that feel nothing, some
    std::ostringstream out, unheard;
    ASSERT_EQ(cli::query(query, out, unheard), 0);
    const auto answer = nlohmann::json::parse(out.str());
    EXPECT_NEAR(static_cast<double>(seen->mu(p)), answer["viscosity"].get<double>(), 1e-4)
        << "point " << p << " at " << p_WR.transpose();
    felt += seen->mu(p) > 0 ? 1 : 0;
  }
  EXPECT_GT(felt, 0u);
  EXPECT_LT(near_a_face, n / 20);

  // The torques are those of a replay through the same pose at the same velocity.
  std::ostringstream log;
  log.precision(17);
  log << "t,turn,bend,slide,qd_turn,qd_bend,qd_slide\n";
  for (int k = -1; k <= 1; ++k) {
    log << 0.001 * (k + 1);
    for (std::size_t c = 0; c < joints; ++c) log << ',' << seen->q(c) + 0.001 * k * seen->qd(c);
    for (std::size_t c = 0; c < joints; ++c) log << ',' << seen->qd(c);
    log << '\n';
  }
  served.folder().write("arm.urdf", cli_test::small_arm);
  cli::ReplayOptions replay;
  replay.field = served.folder().path() / "f.vicinity";
  replay.arm.robot = served.folder().path() / "arm.urdf";
  replay.arm.base = cli_test::small_arm_base;
  replay.arm.points = 900;
  replay.trajectory = served.folder().write("log.csv", log.str());
  replay.output = served.folder().path() / "felt.csv";
  std::ostringstream out, err;
  ASSERT_EQ(cli::replay(replay, out, err), 0) << err.str();
  std::ifstream csv(served.folder().path() / "felt.csv");
  std::string header, row;
  std::getline(csv, header);
  std::getline(csv, row);
  ASSERT_TRUE(std::getline(csv, row)) << header;  // the second tick: the pose itself
  std::istringstream cells(row);
  std::string cell;
  std::getline(cells, cell, ',');
  for (std::size_t c = 0; c < joints; ++c) {
    std::getline(cells, cell, ',');
    const double replayed = std::stod(cell);
    EXPECT_NEAR(seen->tau(c), replayed, 1e-6 + 1e-4 * std::abs(replayed)) << "joint " << c;
  }
}

TEST(Viewer, TheToolGoesWhereItIsPulledAndStaysWhenLetGo) {
  Served served;
  PageClient page(served.port());
  auto seen = next_snapshot(page);
  ASSERT_TRUE(seen);
  const auto tool = [&](std::size_t n) {
    return static_cast<double>(seen->at<float>(128 + 4 * n));
  };
  // A way that the arm can go, and with no layer on it: backwards around its foot.
  const Vec3 start(tool(0), tool(1), tool(2));
  const Vec3 foot = cli_test::small_arm_X_WB().translation();
  const Vec3 target = foot + Eigen::AngleAxisd(0.3, Vec3::UnitZ()) * (start - foot);
  page.send(command(64, 0,
                    bytes_of(std::uint8_t{1}, std::uint8_t{0}, std::uint16_t{0}, 0u, target.x(),
                             target.y(), target.z(), 0., 0., 0., 1.)));
  double nearest = 1;
  for (int n = 0; n < 600 && nearest > 0.01; ++n) {
    seen = next_snapshot(page);
    ASSERT_TRUE(seen);
    nearest = std::min(nearest, (Vec3(tool(0), tool(1), tool(2)) - target).norm());
  }
  EXPECT_LE(nearest, 0.01) << "from " << start.transpose() << " to " << target.transpose();

  page.send(command(64, 0, bytes_of(std::uint8_t{0}, std::uint8_t{0}, std::uint16_t{0}, 0u)));
  for (int n = 0; n < 120; ++n) seen = next_snapshot(page);
  ASSERT_TRUE(seen);
  for (std::size_t c = 0; c < joints; ++c) EXPECT_EQ(seen->qd(c), 0) << "joint " << c;
}

TEST(Viewer, APageThatIsGoneNoLongerPulls) {
  Served served;
  PageClient looks_on(served.port());
  {
    PageClient drives(served.port());
    drives.send(drive_joints(-2, 0, 0));
    bool driven = false;
    for (int n = 0; n < 300 && !driven; ++n) {
      const auto seen = next_snapshot(looks_on);
      ASSERT_TRUE(seen);
      driven = seen->at<std::uint8_t>(65) == 2;
    }
    ASSERT_TRUE(driven);
  }
  bool held = false;
  for (int n = 0; n < 300 && !held; ++n) {
    const auto seen = next_snapshot(looks_on);
    ASSERT_TRUE(seen);
    held = seen->at<std::uint8_t>(65) == 0;
  }
  EXPECT_TRUE(held);
}

TEST(Viewer, AnotherCodingIsFeltWithoutARebuildAndToldToEveryPage) {
  Served served;
  PageClient one(served.port()), other(served.port());
  ASSERT_TRUE(one.next_of(1));
  ASSERT_TRUE(other.next_of(1));
  one.send(
      command(69, 7, R"({"coding": [300, 200, 100], "memory": "rising", "direction": "closing"})"));
  const auto done = one.answer(7);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->type(), 13) << done->text();
  const auto told = other.next_of(8);
  ASSERT_TRUE(told);
  const auto feel = json_of(*told);
  EXPECT_EQ(feel["codings"]["block"]["coding"], nlohmann::json({300, 200, 100}));
  EXPECT_EQ(feel["memory"], "rising");
  const auto seen = felt_snapshot(one);
  ASSERT_TRUE(seen);
  EXPECT_GE(seen->at<float>(196), 100.f);  // the highest mu_e among the points

  one.send(command(69, 8, R"({"coding": [1]})"));
  const auto refused = one.answer(8);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->type(), 14);
  EXPECT_THAT(std::string(refused->text()), HasSubstr("sentence"));
  one.send(command(69, 9, R"({"memmory": "none"})"));
  EXPECT_THAT(std::string(one.answer(9)->text()), HasSubstr("\"hint\":\"memory\""));
  one.send(command(69, 10, R"({"coding": null, "device": "Touch", "mode": "device"})"));
  const auto again = one.answer(10);
  ASSERT_TRUE(again);
}

TEST(Viewer, SlicesAndPicksSayWhatTheFieldHolds) {
  Served served;
  PageClient page(served.port());
  const Workspace& w = served.field().workspace();
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    const double where = w.origin[axis] + 7.5 * w.voxel_size;
    page.send(
        command(65, 20u + axis, bytes_of(axis, std::uint8_t{0}, std::uint16_t{0}, 0u, where)));
    const auto slice = page.answer(20u + axis);
    ASSERT_TRUE(slice);
    ASSERT_EQ(slice->type(), 6);
    EXPECT_EQ(slice->number<std::int32_t>(16), 7);
    const auto width = slice->number<std::uint32_t>(20), height = slice->number<std::uint32_t>(24);
    ASSERT_EQ(slice->payload.size(), 40u + width * height);
    for (std::uint32_t v = 0; v < height; ++v) {
      for (std::uint32_t u = 0; u < width; ++u) {
        VoxelIndex at;
        const auto a = static_cast<std::int32_t>(u), b = static_cast<std::int32_t>(v);
        if (axis == 0) at = {7, a, b};
        if (axis == 1) at = {a, 7, b};
        if (axis == 2) at = {a, b, 7};
        ASSERT_EQ(slice->number<std::uint8_t>(40 + v * width + u), served.field().code_at(at));
      }
    }
  }
  page.send(command(68, 30, bytes_of(0.0, 0.0, 0.065)));
  const auto pick = json_of(*page.answer(30));
  EXPECT_EQ(pick["object"], "block");
  EXPECT_EQ(pick["rank"], 1);
  EXPECT_EQ(pick["viscosity"], 30.0);
  page.send(command(68, 31, bytes_of(std::nan(""), 0.0, 0.0)));
  EXPECT_EQ(page.answer(31)->type(), 14);
  const std::uint16_t block = served.field().objects()[0].name == "block" ? 0 : 1;
  page.send(command(67, 32, bytes_of(std::uint8_t{0}, std::uint8_t{0}, block)));
  const auto mesh = page.answer(32);
  EXPECT_EQ(mesh->number<std::uint32_t>(20), 12u);  // a box has twelve triangles
}

TEST(Viewer, AnUploadedMeshIsBuiltSavedAndOpenedAgain) {
  Served served;
  const auto file = served.folder().path() / "part.stl";
  write_stl(primitive::box({20, 20, 40}), file);
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_EQ(put(served.port(), "/upload?name=part.stl", bytes).status, 201);

  PageClient page(served.port()), other(served.port());
  auto scene = json_of(*page.next_of(1))["scene"]["scene"];
  ASSERT_TRUE(other.next_of(1));
  scene["objects"].push_back({{"name", "part"},
                              {"mesh", "meshes/part.stl"},
                              {"units", "mm"},
                              {"pose", {{"xyz", {0, 0.2, 0}}, {"rpy", {0, 0, 0.5}}}},
                              {"m", 1},
                              {"q", 2},
                              {"coding", {9, 8}}});
  page.send(command(72, 40, nlohmann::json{{"scene", scene}}.dump()));
  const auto built = page.answer(40, std::chrono::seconds(60));
  ASSERT_TRUE(built);
  ASSERT_EQ(built->type(), 13) << built->text();
  const auto told = other.next_of(1);
  ASSERT_TRUE(told);
  const auto hello = json_of(*told);
  EXPECT_EQ(hello["generation"], 2);
  EXPECT_EQ(hello["field"]["objects"][2]["name"], "part");

  page.send(command(73, 41, nlohmann::json{{"name", "mine.yaml"}, {"scene", scene}}.dump()));
  const auto saved = page.answer(41);
  ASSERT_EQ(saved->type(), 13) << saved->text();
  const auto path = served.folder().path() / "files" / "mine.yaml";
  const Scene read = read_scene(path);
  ASSERT_EQ(read.objects.size(), 3u);
  EXPECT_EQ(read.objects[2].q, 2);
  EXPECT_EQ(read.objects[2].coding.mu, (std::vector<double>{9, 8}));
  EXPECT_EQ(read.voxel_size, 0.01);

  page.send(command(74, 42, R"({"name": "mine.yaml"})"));
  const auto opened = page.answer(42);
  ASSERT_EQ(opened->type(), 11) << opened->text();
  EXPECT_EQ(json_of(*opened)["scene"], scene);

  // No mesh but those that were uploaded or are known.
  scene["objects"][2]["mesh"] = (served.folder().path() / "part.stl").string();
  page.send(command(72, 43, nlohmann::json{{"scene", scene}}.dump()));
  EXPECT_THAT(std::string(page.answer(43)->text()), HasSubstr("uploaded"));
  // Without a unit: its size in each of them.
  scene["objects"][2]["mesh"] = "meshes/part.stl";
  scene["objects"][2].erase("units");
  page.send(command(72, 44, nlohmann::json{{"scene", scene}}.dump()));
  EXPECT_THAT(std::string(page.answer(44)->text()), HasSubstr("if the unit is mm"));
}

TEST(Viewer, ARecordingOfReplayIsPlayedAndFollowed) {
  Served served;
  save_field(served.field(), served.folder().path() / "f.vicinity");
  served.folder().write("arm.urdf", cli_test::small_arm);
  cli::ReplayOptions replay;
  replay.field = served.folder().path() / "f.vicinity";
  replay.arm.robot = served.folder().path() / "arm.urdf";
  replay.arm.base = cli_test::small_arm_base;
  replay.arm.points = 900;
  replay.trajectory = served.folder().write(
      "log.csv", cli_test::log_of(cli_test::parabola, cli_test::every(1000, 0.9)));
  replay.output = served.folder().path() / "felt.csv";
  std::ostringstream out, err;
  ASSERT_EQ(cli::replay(replay, out, err), 0) << err.str();
  std::ifstream stream(replay.output, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_EQ(put(served.port(), "/upload?name=felt.csv", bytes).status, 201);

  PageClient page(served.port());
  page.send(command(70, 50, R"({"name": "felt.csv"})"));
  const auto message = page.answer(50);
  ASSERT_TRUE(message);
  ASSERT_EQ(message->type(), 9) << message->text();
  const auto json_size = message->number<std::uint32_t>(8);
  const auto rows = message->number<std::uint32_t>(12), frames = message->number<std::uint32_t>(16);
  const auto links = message->number<std::uint32_t>(20);
  const auto json = nlohmann::json::parse(message->payload.substr(24, json_size));
  EXPECT_GE(rows, 900u);
  EXPECT_EQ(frames, rows);
  EXPECT_EQ(links, 4u);
  const std::vector<std::string> columns = json["columns"];
  EXPECT_THAT(columns, testing::IsSupersetOf({"tau_turn", "fx", "q_turn"}));
  const std::size_t begin = (24 + json_size + 7) / 8 * 8;
  const std::size_t size =
      begin + 8 * rows * (1 + columns.size()) + 8 * frames + 28 * links * frames;
  ASSERT_EQ(message->payload.size(), size);
  EXPECT_NEAR(message->number<double>(begin + 8 * 450), 0.45, 1e-9);
  EXPECT_GT(json["reasons"].size(), 1u);

  page.send(command(71, 51, R"({"recording": 1, "time": 0.2, "speed": 1, "playing": false})"));
  ASSERT_EQ(page.answer(51)->type(), 13);
  const Vec3 there = cli_test::parabola(0.2);
  double off = 1;
  for (int n = 0; n < 600 && off > 1e-6; ++n) {
    const auto seen = next_snapshot(page);
    ASSERT_TRUE(seen);
    if (seen->at<std::uint8_t>(65) != 3) continue;
    off = (Vec3(seen->q(0), seen->q(1), seen->q(2)) - there).norm();
  }
  EXPECT_LE(off, 1e-6) << "the arm has not come to where the recording is";

  // Another page drove before, and is closed: it does not stop what was asked for after it.
  const auto mode_after = [&](int snapshots) {
    std::uint8_t mode = 255;
    for (int n = 0; n < snapshots; ++n) {
      if (const auto seen = next_snapshot(page)) mode = seen->at<std::uint8_t>(65);
    }
    return mode;
  };
  {
    PageClient drives(served.port());
    drives.send(drive_joints(0, 0, 0));
    ASSERT_TRUE(drives.next_of(3));
    page.send(command(71, 52, R"({"recording": 1, "time": 0, "speed": 1, "loop": true})"));
    ASSERT_EQ(page.answer(52)->type(), 13);
  }
  EXPECT_EQ(mode_after(20), 3);

  // A DRIVE that comes after a FOLLOW counts, though the FOLLOW waits behind other work.
  for (std::uint32_t round = 0; round < 5; ++round) {
    for (std::uint32_t n = 0; n < 4; ++n) {
      page.send(command(65, 60 + n,
                        bytes_of(std::uint8_t{2}, std::uint8_t{0}, std::uint16_t{512}, 0u, 0.0)));
    }
    page.send(command(71, 70 + round, R"({"recording": 1, "time": 0, "speed": 1, "loop": true})"));
    page.send(command(64, 0, bytes_of(std::uint8_t{0}, std::uint8_t{0}, std::uint16_t{0}, 0u)));
    ASSERT_EQ(page.answer(70 + round)->type(), 13);
    EXPECT_EQ(mode_after(3), 0) << "round " << round;
  }
}

}  // namespace
}  // namespace vicinity::viewer_test
