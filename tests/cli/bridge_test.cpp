// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity bridge becomes vicinity-bridge, wherever that is: here a script stands for it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "program.h"

namespace vicinity::cli_test {
namespace {

using testing::HasSubstr;

class BridgeCommand : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "bin");
    std::filesystem::create_directory(folder_ / "elsewhere");
    std::filesystem::copy_file(VICINITY_PROGRAM, folder_ / "bin/vicinity");
  }
  // Says its name, its process and its arguments, one a line.
  void put_bridge(const std::string& where) {
    const auto script = folder_.write(
        where + "/vicinity-bridge", "#!/bin/sh\nprintf '%s\\n' " + where + " $$ \"$@\"\nexit 7\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  }
  // Runs it in the place of a shell that has written down its own process.
  Answer bridge() {
    const std::string command = "cd '" + folder_.path().string() +
                                "' && PATH=$PWD/elsewhere && echo $$ >pid && "
                                "exec bin/vicinity bridge cell 'a b' '' >out 2>err";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), text_of(folder_ / "out"), text_of(folder_ / "err")};
  }
  std::string as_seen_by(const std::string& where) {
    return where + "\n" + text_of(folder_ / "pid") + "cell\na b\n\n";
  }

  Folder folder_;
};

TEST_F(BridgeCommand, IsTheProgramBesideItInTheSameProcess) {
  put_bridge("elsewhere");
  put_bridge("bin");
  const Answer answer = bridge();
  EXPECT_EQ(answer.code, 7) << answer.err;
  EXPECT_EQ(answer.out, as_seen_by("bin"));
}

TEST_F(BridgeCommand, IsTheOneOnPathWhereNoneIsBesideIt) {
  put_bridge("elsewhere");
  const Answer answer = bridge();
  EXPECT_EQ(answer.code, 7) << answer.err;
  EXPECT_EQ(answer.out, as_seen_by("elsewhere"));
}

TEST_F(BridgeCommand, SaysHowToGetItWhereThereIsNone) {
  const Answer answer = bridge();
  EXPECT_EQ(answer.code, 2);
  EXPECT_EQ(answer.out, "");
  EXPECT_THAT(answer.err, HasSubstr("installing the package vicinity-bridge"));
  EXPECT_EQ(std::ranges::count(answer.err, '\n'), 1) << answer.err;
}

}  // namespace
}  // namespace vicinity::cli_test
