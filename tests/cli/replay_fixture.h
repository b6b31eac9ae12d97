// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The small arm beside the small scene: replayed by the program, and by a plain loop over the
/// tick.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "program.h"
#include "small_arm.h"
#include "vicinity/teleop/tick.h"

namespace vicinity::cli_test {

/// One line of the output, by column.
using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::filesystem::path& csv);

/// Torques on turn, bend and slide.
Vec3 torque_of(const Row& row);

class Replay : public testing::Test {
 protected:
  /// Of log.csv: the parabola at 1 kHz [s].
  static constexpr double length_s = 0.9;

  static void SetUpTestSuite();
  static void TearDownTestSuite();

  static std::vector<std::string> arguments(const std::string& log,
                                            const std::vector<std::string>& more);
  static Answer replay(const std::string& log, const std::vector<std::string>& more);

  /// The plain loop: the motion itself at k/1000, no log in between. Without velocities they are
  /// differenced.
  static std::vector<Output> direct(const Motion& motion, int ticks,
                                    const TeleoperationOptions& options = {},
                                    const Motion& velocity = {});

  static void expect_equal(const std::vector<Row>& rows, const std::vector<Output>& outputs,
                           double slack);

  static Folder* folder_;
};

}  // namespace vicinity::cli_test
