// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity replay: what it writes is what the tick gives, for every way a log can be written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <time.h>

#include <cmath>
#include <iomanip>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

#include "program.h"
#include "small_arm.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/teleop/tick.h"
#include "vicinity/viscosity/field_file.h"

namespace vicinity::cli_test {
namespace {

using testing::HasSubstr;

constexpr double length_s = 0.9;

// One line of the output, by column.
using Row = std::map<std::string, std::string>;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

std::vector<Row> rows_of(const std::filesystem::path& csv) {
  std::istringstream text(text_of(csv));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> header = cells_of(line);
  std::vector<Row> rows;
  while (std::getline(text, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), header.size()) << line;
    Row row;
    for (std::size_t n = 0; n < std::min(cells.size(), header.size()); ++n)
      row[header[n]] = cells[n];
    rows.push_back(row);
  }
  return rows;
}

Vec3 torque_of(const Row& row) {
  return {std::stod(row.at("tau_turn")), std::stod(row.at("tau_bend")),
          std::stod(row.at("tau_slide"))};
}

class Replay : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    folder_->write("scene.yaml", small_scene);
    folder_->write("arm.urdf", small_arm);
    folder_->write("log.csv", log_of(parabola, every(1000, length_s)));
    ASSERT_EQ(folder_->run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  static std::vector<std::string> arguments(const std::string& log,
                                            const std::vector<std::string>& more) {
    std::vector<std::string> all = {"replay",
                                    "f.vicinity",
                                    "--robot",
                                    "arm.urdf",
                                    std::string("--base=") + small_arm_base,
                                    "--trajectory",
                                    log,
                                    "--points",
                                    "900"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  static Answer replay(const std::string& log, const std::vector<std::string>& more) {
    return folder_->run(arguments(log, more));
  }

  // The plain loop: the motion itself at k/1000, no log in between.
  static std::vector<Output> direct(const Motion& motion, int ticks,
                                    const TeleoperationOptions& options = {},
                                    const Motion& velocity = {}) {
    const RobotModel robot = read_urdf(*folder_ / "arm.urdf").robot;
    BodyPointOptions points;
    points.total = 900;
    const ViscosityField field = open_field(*folder_ / "f.vicinity");
    Teleoperation teleoperation(robot, sample_body_points(robot, points), field, options);
    std::vector<Output> outputs(static_cast<std::size_t>(ticks));
    for (int k = 0; k < ticks; ++k) {
      const Vec3 q = motion(k / 1000.0);
      const Vec3 qd = velocity ? velocity(k / 1000.0) : Vec3::Zero();
      const Input input{.time_s = k / 1000.0,
                        .q = q.data(),
                        .qd = velocity ? qd.data() : nullptr,
                        .joint_count = 3,
                        .X_WB = small_arm_X_WB()};
      (void)teleoperation.tick(input, outputs[static_cast<std::size_t>(k)]);
    }
    return outputs;
  }

  static void expect_equal(const std::vector<Row>& rows, const std::vector<Output>& outputs,
                           double slack) {
    ASSERT_EQ(rows.size(), outputs.size());
    double most = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Vec3 torque = outputs[k].torque;
      ASSERT_LE((torque_of(rows[k]) - torque).norm(), slack)
          << "tick " << k << ": " << torque_of(rows[k]).transpose() << " is not "
          << torque.transpose();
      most = std::max(most, torque.norm());
    }
    EXPECT_GT(most, 1e-3) << "nothing was felt";
  }

  static Folder* folder_;
};

Folder* Replay::folder_ = nullptr;

TEST_F(Replay, WritesWhatADirectLoopOverTheTickGives) {
  const Answer answer = replay("log.csv", {"-o", "felt.csv", "--memory", "rising"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  TeleoperationOptions options;
  options.memory = named_memory("rising");
  const std::vector<Output> outputs = direct(parabola, 901, options);
  expect_equal(rows, outputs, 1e-7);
  const RobotModel robot = read_urdf(*folder_ / "arm.urdf").robot;
  const ViscosityField field = open_field(*folder_ / "f.vicinity");
  std::size_t reasons = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Output& output = outputs[k];
    ASSERT_EQ(rows[k].at("status"), to_string(output.status));
    EXPECT_NEAR(std::stod(rows[k].at("fx")), output.tool.force.x(), 1e-6);
    EXPECT_NEAR(std::stod(rows[k].at("mz")), output.tool.moment.z(), 1e-6);
    EXPECT_NEAR(std::stod(rows[k].at("master_force")), output.master_force, 1e-5);
    const Reason& reason = output.reason;
    if (reason.object < 0) {
      EXPECT_EQ(rows[k].at("reason_object") + rows[k].at("reason_rank"), "") << "tick " << k;
      continue;
    }
    ++reasons;
    EXPECT_EQ(rows[k].at("reason_link"), robot.links[static_cast<std::size_t>(reason.link)].name);
    EXPECT_EQ(rows[k].at("reason_object"),
              field.objects()[static_cast<std::size_t>(reason.object)].name);
    EXPECT_EQ(rows[k].at("reason_rank"), std::to_string(reason.rank));
    EXPECT_NEAR(std::stod(rows[k].at("reason_distance_mm")), 1000 * reason.distance_m, 1e-4);
  }
  EXPECT_GT(reasons, 100u);
}

TEST_F(Replay, HasTheDocumentedColumns) {
  ASSERT_EQ(replay("log.csv", {"-o", "felt.csv"}).code, 0);
  const std::string text = text_of(*folder_ / "felt.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "t,tau_turn,tau_bend,tau_slide,fx,fy,fz,mx,my,mz,master_force,status,reason_link,"
            "reason_object,reason_rank,reason_distance_mm");
}

// Uneven samples, about ten ticks apart, of a motion that parabolas give back exactly.
TEST_F(Replay, RunsSmoothlyBetweenTheSamplesOfASlowLog) {
  constexpr unsigned seed = 5;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::vector<double> times = {0};
  while (times.back() < length_s) {
    times.push_back(times.back() + std::uniform_real_distribution(0.004, 0.017)(random));
  }
  folder_->write("slow.csv", log_of(parabola, times));
  const Answer answer = replay("slow.csv", {"-o", "felt.csv"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(std::floor(1000 * times.back())) + 1);
  expect_equal(rows, direct(parabola, static_cast<int>(rows.size())), 1e-7);
}

// 100 Hz of a motion that is no parabola. The cubic's velocity is off by some h²/12 of the third
// derivative, a thousandth here; the rest is points that change voxels a tick sooner or later.
TEST_F(Replay, StaysCloseToASineThatWasLoggedSlowly) {
  const Motion sine = [](double t) -> Vec3 {
    return {0.7 + 0.3 * std::sin(4 * t), 0.2 * std::sin(3 * t), 0.03 * std::sin(5 * t)};
  };
  folder_->write("sine.csv", log_of(sine, every(100, length_s)));
  ASSERT_EQ(replay("sine.csv", {"-o", "felt.csv"}).code, 0);
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  const std::vector<Output> outputs = direct(sine, static_cast<int>(rows.size()));
  double difference = 0, most = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Vec3 torque = outputs[k].torque;
    difference += (torque_of(rows[k]) - torque).squaredNorm();
    most += torque.squaredNorm();
  }
  EXPECT_LT(std::sqrt(difference / most), 0.01);
}

TEST_F(Replay, GoesThereAndBackForAsLongAsAsked) {
  ASSERT_EQ(replay("log.csv", {"-o", "felt.csv", "--duration", "2.2"}).code, 0);
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  const Motion there_and_back = [](double t) {
    const double turn = std::fmod(t, 2 * length_s);
    return parabola(turn > length_s ? 2 * length_s - turn : turn);
  };
  expect_equal(rows, direct(there_and_back, 2201), 1e-6);
}

TEST_F(Replay, HandsRecordedVelocitiesToTheTick) {
  const Motion wrong = [](double t) -> Vec3 { return 1.5 * parabola_velocity(t); };
  std::ostringstream log;
  log << std::setprecision(17) << "t,turn,bend,slide,w1,w2,w3\n";
  for (const double t : every(1000, length_s)) {
    const Vec3 q = parabola(t), qd = wrong(t);
    log << t << ',' << q.x() << ',' << q.y() << ',' << q.z() << ',' << qd.x() << ',' << qd.y()
        << ',' << qd.z() << '\n';
  }
  folder_->write("fast.csv", log.str());
  ASSERT_EQ(
      replay("fast.csv", {"-o", "felt.csv", "--columns", "qd_turn=w1,qd_bend=w2,qd_slide=w3"}).code,
      0);
  expect_equal(rows_of(*folder_ / "felt.csv"), direct(parabola, 901, {}, wrong), 1e-6);
}

// One motion in the hand of several loggers.
TEST_F(Replay, ReadsTheSameMotionHoweverItIsWritten) {
  ASSERT_EQ(replay("log.csv", {"-o", "plain.csv"}).code, 0);
  const std::vector<Row> plain = rows_of(*folder_ / "plain.csv");
  const double degree = std::numbers::pi / 180;
  struct Way {
    const char *name, *header, *separator, *line_end, *columns;
    double time, angle, length;
  };
  const Way ways[] = {
      {"factors", "Time,P1,P2,P3", ",", "\n",
       "t=Time*0.001,turn=P1*0.017453292519943295,bend=P2*0.017453292519943295,slide=P3*1e-3", 1000,
       1 / degree, 1000},
      {"units in the header", "time [ms],turn (deg),bend [°],slide [mm]", ",", "\n", "", 1000,
       1 / degree, 1000},
      {"byte order mark, CRLF, blanks and quotes", "\xEF\xBB\xBF\"t\", turn ,\"bend\", slide",
       " , ", "\r\n", "", 1, 1, 1},
      {"semicolons and a blank last line", "\n\nt;turn;bend;slide", ";", "\n\n", "", 1, 1, 1},
      {"tabs, and a name of its own for time", "stamp\tturn\tbend\tslide", "\t", "\n", "t=stamp", 1,
       1, 1},
  };
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    std::ostringstream log;
    log << std::setprecision(17) << way.header << way.line_end;
    for (const double t : every(1000, length_s)) {
      const Vec3 q = parabola(t);
      log << way.time * t << way.separator << way.angle * q.x() << way.separator
          << way.angle * q.y() << way.separator << way.length * q.z() << way.line_end;
    }
    folder_->write("other.csv", log.str());
    const Answer answer = replay("other.csv", {"-o", "felt.csv", "--columns", way.columns});
    ASSERT_EQ(answer.code, 0) << answer.err;
    const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
    ASSERT_EQ(rows.size(), plain.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
      ASSERT_LE((torque_of(rows[k]) - torque_of(plain[k])).norm(), 1e-7) << "tick " << k;
    }
  }
}

TEST_F(Replay, UnwrapsAContinuousJointAndSaysSo) {
  const Motion wrapped = [](double t) {
    Vec3 q = parabola(t);
    // Wraps where the joint passes 0.8, which it does twice.
    if (q.x() > 0.8) q.x() -= 2 * std::numbers::pi;
    return q;
  };
  folder_->write("wrapped.csv", log_of(wrapped, every(1000, length_s)));
  const Answer answer = replay("wrapped.csv", {"-o", "felt.csv"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("'turn' wraps around 2 times"));
  expect_equal(rows_of(*folder_ / "felt.csv"), direct(parabola, 901), 1e-6);
}

TEST_F(Replay, JsonLinesSayWhatTheCsvSays) {
  ASSERT_EQ(replay("log.csv", {"-o", "felt.csv"}).code, 0);
  ASSERT_EQ(replay("log.csv", {"-o", "felt.jsonl"}).code, 0);
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  std::istringstream lines(text_of(*folder_ / "felt.jsonl"));
  std::string line;
  std::size_t k = 0;
  for (; std::getline(lines, line); ++k) {
    ASSERT_LT(k, rows.size());
    const auto json = nlohmann::json::parse(line);
    ASSERT_EQ(json.size(), rows[k].size());
    for (const auto& [name, cell] : rows[k]) {
      const auto& value = json.at(name);
      if (value.is_null()) {
        EXPECT_EQ(cell, "") << name;
      } else if (value.is_number()) {
        EXPECT_EQ(value.get<double>(), std::stod(cell)) << name;
      } else {
        EXPECT_EQ(value.get<std::string>(), cell) << name;
      }
    }
  }
  EXPECT_EQ(k, rows.size());
}

TEST_F(Replay, JsonSummaryCountsWhatTheFileHolds) {
  const Answer answer = replay("log.csv", {"-o", "felt.csv", "--json"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  const auto json = answer.json();
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  std::map<std::string, std::uint64_t> statuses;
  double strongest = 0;
  for (const Row& row : rows) {
    ++statuses[row.at("status")];
    strongest = std::max(
        strongest,
        Vec3(std::stod(row.at("fx")), std::stod(row.at("fy")), std::stod(row.at("fz"))).norm());
  }
  EXPECT_EQ(json["ticks"], rows.size());
  EXPECT_EQ((json["statuses"].get<std::map<std::string, std::uint64_t>>()), statuses);
  EXPECT_NEAR(json["strongest"]["force"].get<double>(), strongest, 1e-8 * strongest);
  std::uint64_t timed = 0;
  for (const auto& bin : json["tick_us"]["bins"]) timed += bin["ticks"].get<std::uint64_t>();
  EXPECT_EQ(timed, rows.size());
  EXPECT_EQ(json["energy"]["unaccounted"], 0);
  EXPECT_GT(json["energy"]["drag"], 0);
  EXPECT_FALSE(json["interrupted"].get<bool>());
}

TEST_F(Replay, StrictNeverFeedsTheMotionAndShowsWhatItCost) {
  folder_->write("master.yaml",
                 "name: bench arm\naxes: joints\naxis_count: 3\nphysical_damping: 0.002\n");
  const Answer answer = replay("log.csv", {"--device", "master.yaml", "--json"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  const auto json = answer.json();
  EXPECT_TRUE(json["energy"]["passive"].get<bool>());
  EXPECT_GT(json["limiter"]["limits"]["damping"], 0);
  EXPECT_LT(json["limiter"]["lowest_scale"], 1);
  EXPECT_THAT(json["limiter"]["words"], HasSubstr("strict mode, device 'bench arm'"));
}

TEST_F(Replay, TheSceneKnowsTheArmAndTheCommandLineWins) {
  folder_->write("with_arm.yaml", std::string(small_scene) +
                                      "robot:\n  urdf: arm.urdf\n  base: {xyz: [-0.05, -0.21, "
                                      "0.02], rpy: [0, 0, 0.4]}\n  points_per_m2: 5000\n");
  ASSERT_EQ(replay("log.csv", {"-o", "plain.csv"}).code, 0);
  ASSERT_EQ(folder_
                ->run({"replay", "f.vicinity", "--scene", "with_arm.yaml", "--points", "900",
                       "--trajectory", "log.csv", "-o", "felt.csv"})
                .code,
            0);
  EXPECT_EQ(text_of(*folder_ / "felt.csv"), text_of(*folder_ / "plain.csv"));
}

TEST_F(Replay, DrawsAPictureInBothFormats) {
  for (const char* name : {"felt.svg", "felt.png"}) {
    ASSERT_EQ(replay("log.csv", {"--plot", name}).code, 0);
    EXPECT_GT(std::filesystem::file_size(*folder_ / name), 5000u) << name;
  }
}

TEST_F(Replay, InRealTimeItSaysWhatTheSystemGrantedAndWhatWasMissed) {
  const Answer answer = replay("log.csv", {"-o", "felt.csv", "--realtime", "--duration", "0.4"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  for (const char* word : {"processor", "SCHED_FIFO", "memory ", "missed", "resident"}) {
    EXPECT_THAT(answer.out, HasSubstr(word));
  }
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  ASSERT_FALSE(rows.empty());
  for (std::size_t k = 1; k < rows.size(); ++k) {
    ASSERT_GT(std::stod(rows[k].at("t")), std::stod(rows[k - 1].at("t"))) << "tick " << k;
  }
}

TEST_F(Replay, InterruptedItLeavesWholeLinesOfWhatItHas) {
  const pid_t process =
      folder_->start(arguments("log.csv", {"-o", "cut.csv", "--realtime", "--duration", "300"}));
  const timespec a_while{.tv_sec = 1, .tv_nsec = 0};
  nanosleep(&a_while, nullptr);
  kill(process, SIGINT);
  EXPECT_EQ(wait_for(process), 130);
  ASSERT_TRUE(std::filesystem::exists(*folder_ / "cut.csv"));
  const std::vector<Row> rows = rows_of(*folder_ / "cut.csv");
  EXPECT_FALSE(rows.empty());
  EXPECT_LT(rows.size(), 300'000u);
  EXPECT_EQ(text_of(*folder_ / "cut.csv").back(), '\n');
  EXPECT_THAT(folder_->files(), testing::Not(testing::Contains(HasSubstr(".part"))));
}

TEST_F(Replay, CheckOnlyTicksNothingAndSaysWhatIsOdd) {
  folder_->write("odd.csv", "t,turn,bend,slide\n0,0,90,0\n0.01,0,90,0\n0.02,0,91,0\n0.5,0,92,0\n");
  const auto files = folder_->files();
  const Answer answer = replay("odd.csv", {"--check-only", "-o", "never.csv"});
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("are these degrees?"));
  EXPECT_THAT(answer.out, HasSubstr("1 gap, the longest of 0.48 s before line 5"));
  EXPECT_EQ(folder_->files(), files);
  const Answer lost = folder_->run({"replay", "f.vicinity", "--robot", "arm.urdf", "--check-only",
                                    "--base", "9,9,9,0,0,0", "--json"});
  EXPECT_THAT(lost.json()["remarks"].dump(), HasSubstr("never comes into the field"));
  const Answer inside = folder_->run(
      {"replay", "f.vicinity", "--robot", "arm.urdf", "--check-only", "--base", "0,0,0,0,0,0"});
  EXPECT_THAT(inside.out, HasSubstr("points of upper are in or inside block"));
}

}  // namespace
}  // namespace vicinity::cli_test
