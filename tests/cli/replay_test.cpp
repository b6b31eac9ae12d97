// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity replay: what it writes is what the tick gives, and what it says is what it wrote.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <time.h>

#include <map>
#include <set>
#include <sstream>

#include "replay_fixture.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/field_file.h"

namespace vicinity::cli_test {
namespace {

using testing::HasSubstr;

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
  std::set<int> ranks;
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
    ranks.insert(reason.rank);
    EXPECT_EQ(rows[k].at("reason_link"), robot.links[static_cast<std::size_t>(reason.link)].name);
    EXPECT_EQ(rows[k].at("reason_object"),
              field.objects()[static_cast<std::size_t>(reason.object)].name);
    EXPECT_EQ(rows[k].at("reason_rank"), std::to_string(reason.rank));
    EXPECT_NEAR(std::stod(rows[k].at("reason_distance_mm")), 1000 * reason.distance_m, 1e-4);
  }
  EXPECT_THAT(ranks, testing::ElementsAre(1, 2, 3)) << "other ranks would test less";
}

TEST_F(Replay, HasTheDocumentedColumns) {
  ASSERT_EQ(replay("log.csv", {"-o", "felt.csv"}).code, 0);
  const std::string text = text_of(*folder_ / "felt.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "t,tau_turn,tau_bend,tau_slide,fx,fy,fz,mx,my,mz,master_force,status,reason_link,"
            "reason_object,reason_rank,reason_distance_mm,q_turn,q_bend,q_slide");
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
                 "name: bench arm\naxes: joints\naxis_count: 3\nphysical_damping: 0.0002\n");
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
                                      "robot:\n  urdf: arm.urdf\n  base: {xyz: [-0.12, -0.22, "
                                      "0.02], rpy: [0, 0, -0.3]}\n  points_per_m2: 5000\n");
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

TEST_F(Replay, InRealTimeEveryMissIsCountedOnceAndHasACause) {
  const Answer answer = replay("log.csv", {"-o", "felt.csv", "--realtime", "--json"});
  ASSERT_EQ(answer.code, 0) << answer.err;
  const auto json = answer.json();
  std::uint64_t late = 0;
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double period = std::stod(rows[k].at("t")) - std::stod(rows[k - 1].at("t"));
    const bool missed = rows[k].at("status") == "deadline missed";
    EXPECT_EQ(missed, period > 0.0015) << "tick " << k << ", after " << period << " s";
    late += missed ? 1 : 0;
  }
  const auto& real_time = json["real_time"];
  EXPECT_EQ(real_time["late_wake_ups"].get<std::uint64_t>() +
                real_time["long_ticks"].get<std::uint64_t>(),
            late);
  EXPECT_EQ(rows.size() + real_time["skipped"].get<std::uint64_t>(), 901u);
}

TEST_F(Replay, InterruptedItLeavesWholeLinesOfWhatItHas) {
  const pid_t process =
      folder_->start(arguments("log.csv", {"-o", "cut.csv", "--realtime", "--duration", "300"}));
  const timespec a_while{.tv_sec = 3, .tv_nsec = 0};  // a sanitized program starts slowly
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
