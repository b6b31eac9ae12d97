// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// However a build ends, the field is whole, or not there.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <time.h>

#include <random>

#include "program.h"

namespace vicinity::cli_test {
namespace {

// Takes about a second, of which the writing is a part.
constexpr const char* slow_scene = R"(voxel_size: 0.004
defaults: {m: 2, q: 6}
objects:
  - name: ball
    primitive: {sphere: {radius: 0.5}}
  - name: ring
    primitive: {torus: {radius: 0.8, tube_radius: 0.1}}
)";

void sleep_ms(long ms) {
  const timespec duration = {ms / 1000, ms % 1000 * 1'000'000};
  nanosleep(&duration, nullptr);
}

class InterruptedBuild : public testing::TestWithParam<int> {};

TEST_P(InterruptedBuild, LeavesAWholeFieldOrNone) {
  const int signal = GetParam();
  constexpr unsigned seed = 11;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const Folder folder;
  folder.write("scene.yaml", slow_scene);
  for (int attempt = 0; attempt < 8; ++attempt) {
    const pid_t process = folder.start({"build", "scene.yaml", "-o", "f.vicinity"});
    sleep_ms(std::uniform_int_distribution(1, 900)(random));
    kill(process, signal);
    const int code = wait_for(process);
    EXPECT_TRUE(code == 0 || code == 130 || code == 128 + signal) << code;
    if (std::filesystem::exists(folder / "f.vicinity")) {
      EXPECT_EQ(folder.run({"info", "f.vicinity", "--json"}).code, 0);
      std::filesystem::remove(folder / "f.vicinity");
    } else {
      EXPECT_NE(code, 0);
    }
    // Nobody can tidy up after SIGKILL.
    if (signal != SIGKILL) {
      EXPECT_THAT(folder.files(), testing::ElementsAre("scene.yaml"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, InterruptedBuild, testing::Values(SIGINT, SIGTERM, SIGKILL),
                         [](const auto& which) { return std::string(sigabbrev_np(which.param)); });

// A sanitizer takes more addresses for itself than such a limit leaves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(BuildWithoutMemory, SaysSoInASentenceAndLeavesNothing) {
  const Folder folder;
  std::string large = slow_scene;
  large.replace(large.find("0.004"), 5, "0.001");
  folder.write("scene.yaml", large);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  // Where memory ends decides which of the threads is told first, and in which stage.
  for (const rlim_t megabytes : {220, 260, 300, 340, 400, 450}) {
    SCOPED_TRACE(testing::Message() << megabytes << " MB");
    const rlimit small = {megabytes * 1'000'000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_AS, &small), 0);  // children take it over
    const Answer answer = folder.run({"build", "scene.yaml", "-o", "f.vicinity"});
    ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
    EXPECT_EQ(answer.code, 1);
    EXPECT_THAT(answer.err, testing::HasSubstr("too little memory for that; try a larger"));
    EXPECT_THAT(folder.files(), testing::ElementsAre("scene.yaml"));
  }
}
#endif

TEST(InterruptedExport, LeavesNothing) {
  const Folder folder;
  folder.write("scene.yaml", slow_scene);
  ASSERT_EQ(folder.run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
  const pid_t process =
      folder.start({"export", "f.vicinity", "-o", "f.npy", "--what", "viscosity"});
  sleep_ms(60);
  kill(process, SIGINT);
  const int code = wait_for(process);
  if (code == 0) {
    EXPECT_THAT(folder.files(),
                testing::ElementsAre("f.json", "f.npy", "f.vicinity", "scene.yaml"));
  } else {
    EXPECT_EQ(code, 130);
    EXPECT_THAT(folder.files(), testing::ElementsAre("f.vicinity", "scene.yaml"));
  }
}

}  // namespace
}  // namespace vicinity::cli_test
