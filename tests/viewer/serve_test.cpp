// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Options that vicinity serve refuses before it listens.

#include "serve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "cli/small_arm.h"
#include "served.h"
#include "shot_view.h"
#include "vicinity/geometry/error.h"

namespace vicinity::viewer_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Served for a moment, on a free port; what it was refused with, if it was.
std::string refusal_of(viewer::ServeOptions options) {
  options.port = 0;
  options.seconds = 0.01;
  std::ostringstream unheard;
  try {
    viewer::serve(options, unheard, unheard);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Serve, RefusesWhatItWouldPassOverInSilence) {
  const ScratchFolder folder;
  viewer::ServeOptions good;
  good.input = folder.write("small.yaml", scene_text);
  good.arm.robot = folder.write("arm.urdf", cli_test::small_arm);
  good.folder = folder.path() / "files";
  good.recordings = {folder.write("felt.csv", "t,turn\n0,0\n")};
  good.start = "0,2,0.1";  // at its limits
  EXPECT_EQ(refusal_of(good), "");

  viewer::ServeOptions bad = good;
  bad.recordings.push_back(folder.path() / "nope.csv");
  EXPECT_THAT(refusal_of(bad), AllOf(HasSubstr("--recording"), HasSubstr("nope.csv")));
  bad = good;
  bad.folder = good.input;
  EXPECT_THAT(refusal_of(bad), AllOf(HasSubstr("--folder"), HasSubstr("no folder")));
  bad = good;
  bad.start = "0,5,0";
  EXPECT_THAT(refusal_of(bad), AllOf(HasSubstr("joint 'bend'"), HasSubstr("-2 to 2")));
  bad = good;
  bad.shot_view = "slice=y:1";
  EXPECT_THAT(refusal_of(bad), HasSubstr("try --shot"));
  bad.shot = folder.path() / "shot.png";
  bad.shot_view = "slice=q:7";
  EXPECT_THAT(refusal_of(bad), HasSubstr("'slice=q:7'"));
}

TEST(Serve, ChecksHowItFeelsAndHowOftenWithoutARobotToo) {
  const ScratchFolder folder;
  viewer::ServeOptions good;
  good.input = folder.write("small.yaml", scene_text);
  good.folder = folder.path() / "files";
  good.arm.rate = 100;
  EXPECT_EQ(refusal_of(good), "");
  for (const double rate : {0.0, -5.0, 1e6}) {
    viewer::ServeOptions bad = good;
    bad.arm.rate = rate;
    EXPECT_THAT(refusal_of(bad), HasSubstr("--rate")) << rate;
  }
  viewer::ServeOptions bad = good;
  bad.arm.master = "1,2";
  EXPECT_THAT(refusal_of(bad), HasSubstr("--master"));
}

TEST(Serve, KnowsEveryWordOfTheAddress) {
  for (const char* view : {"theme=dark&view=iso&slice=y:1.15&cut=off&shells=1,6&panels=off",
                           "theme=light&slice=off&cut=on&shells=all", "view=front", "view=side",
                           "view=top", "slice=x:-0.5", "slice=z:0"}) {
    EXPECT_NO_THROW(viewer::check_shot_view(view)) << view;
  }
  for (const char* view :
       {"slice=q:7", "slice=y", "slice=y:", "slice=y:nan", "slice=y:1&theme=pink", "shells=0",
        "shells=1,,2", "shells=", "veiw=top", "cut=yes", "&&", "x"}) {
    EXPECT_THROW(viewer::check_shot_view(view), Error) << view;
  }
}

}  // namespace
}  // namespace vicinity::viewer_test
