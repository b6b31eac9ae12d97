// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity replay: however a motion was logged, what comes out is what the tick gives for the
// motion.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <numbers>
#include <random>
#include <sstream>

#include "replay_fixture.h"

namespace vicinity::cli_test {
namespace {

using testing::HasSubstr;

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

// 100 Hz of a motion that is no parabola. Slopes are off by h²/6 of the third derivative (h²/3 at
// the ends), less than a thousandth of the largest velocity here; points that change voxels a tick
// sooner or later add to that.
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
  ASSERT_EQ(replay("fast.csv", {"-o", "felt.csv", "--duration", "1.7", "--columns",
                                "qd_turn=w1,qd_bend=w2,qd_slide=w3"})
                .code,
            0);
  // On the way back they point the other way.
  const Motion there_and_back = [](double t) {
    return parabola(t > length_s ? 2 * length_s - t : t);
  };
  const Motion velocity = [&](double t) -> Vec3 {
    return t > length_s ? Vec3(-wrong(2 * length_s - t)) : wrong(t);
  };
  expect_equal(rows_of(*folder_ / "felt.csv"), direct(there_and_back, 1701, {}, velocity), 1e-6);
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
      {"a comma at the end of each line", "t,turn,bend,slide", ",", ",\n", "", 1, 1, 1},
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

TEST_F(Replay, AsksForTheUnitOfTimeOnlyWhereNoneIsNamed) {
  for (const bool named : {false, true}) {
    const std::string header = named ? "t [ms],turn,bend,slide\n" : "t,turn,bend,slide\n";
    folder_->write("slow.csv", header + "0,0,0,0\n4000,0.01,0,0\n8000,0.02,0,0\n");
    const Answer answer = replay("slow.csv", {"--check-only"});
    ASSERT_EQ(answer.code, 0) << answer.err;
    EXPECT_THAT(answer.out, HasSubstr(named ? "one sample every 4 s" : "one sample every 4000 s"));
    EXPECT_EQ(answer.out.find("milliseconds") == std::string::npos, named);
  }
}

// Clocks count seconds since 1970: ten digits before the point and three behind.
TEST_F(Replay, KeepsTheTimeOfALogThatCountsSecondsSinceLong) {
  constexpr double origin = 1.7e9;
  std::ostringstream log;
  log << std::setprecision(17) << "t,turn,bend,slide\n";
  for (const double t : every(1000, length_s)) {
    const Vec3 q = parabola(t);
    log << origin + t << ',' << q.x() << ',' << q.y() << ',' << q.z() << '\n';
  }
  folder_->write("epoch.csv", log.str());
  ASSERT_EQ(replay("epoch.csv", {"-o", "felt.csv"}).code, 0);
  const std::vector<Row> rows = rows_of(*folder_ / "felt.csv");
  ASSERT_GE(rows.size(), 900u);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_NEAR(std::stod(rows[k].at("t")) - origin, 1e-3 * static_cast<double>(k), 1e-6);
    EXPECT_NE(rows[k].at("status"), "deadline missed");
  }
}

}  // namespace
}  // namespace vicinity::cli_test
