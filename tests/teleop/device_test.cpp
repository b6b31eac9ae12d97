// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "vicinity/geometry/error.h"
#include "vicinity/teleop/limiter.h"

namespace vicinity {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string error_of(const std::string& yaml) {
  try {
    parse_device(yaml, "arm.yaml");
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(Device, TheTableHoldsThePublicCeilingsAndInventsNothing) {
  EXPECT_THAT(known_device("touch").damping_ceiling, ElementsAre(4));
  EXPECT_THAT(known_device("phantom omni").damping_ceiling, ElementsAre(5));
  EXPECT_THAT(known_device("falcon").damping_ceiling, ElementsAre(20));
  for (const char* name : {"omega.3", "omega.6", "omega.7", "sigma.7", "lambda.7"}) {
    EXPECT_THAT(known_device(name).damping_ceiling, ElementsAre(30));
  }
  EXPECT_TRUE(std::is_sorted(known_devices().begin(), known_devices().end(),
                             [](const Device& a, const Device& b) { return a.name < b.name; }));
  for (const Device& device : known_devices()) {
    EXPECT_TRUE(device.physical_damping.empty());
    EXPECT_THROW(limiter_options(device, LimiterMode::strict), Error);
    EXPECT_EQ(DragLimiter(limiter_options(device, LimiterMode::device)).mode(),
              LimiterMode::device);
  }
}

TEST(Device, ANameThatIsAlmostKnownIsPointedOut) {
  try {
    known_device("sigma7");
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("try 'sigma.7'"));
    for (const Device& device : known_devices()) EXPECT_THAT(e.what(), HasSubstr(device.name));
  }
}

TEST(Device, OnesOwnIsReadWithEveryField) {
  const Device device = parse_device(R"(
name: bench arm
axes: joints
axis_count: 2
mass: [0.01, 0.02]
physical_damping: 0.4
damping_ceiling: [2, 1]
encoder_step: 1.0e-5
dry_friction: 0
sample_period: 0.0005
force_limit: 9
torque_limits: [4, 3]
)",
                                     "arm.yaml");
  EXPECT_EQ(device.name, "bench arm");
  EXPECT_EQ(device.axes, AxisKind::joints);
  EXPECT_EQ(device.axis_count, 2);
  EXPECT_THAT(device.mass, ElementsAre(0.01, 0.02));
  EXPECT_THAT(device.dry_friction, ElementsAre(0));
  EXPECT_EQ(device.sample_period, 0.0005);

  const LimiterOptions strict = limiter_options(device, LimiterMode::strict);
  EXPECT_EQ(strict.damping, 0.4 * Eigen::Matrix2d::Identity());
  EXPECT_EQ(strict.period_s, 0.0005);
  EXPECT_EQ(strict.dry_friction.size(), 0);  // none there is no bound, not a bound of nothing
  EXPECT_EQ(strict.torque_limits, Eigen::Vector2d(4, 3));
  EXPECT_EQ(limiter_options(device, LimiterMode::device).damping(0, 0), 2);
  EXPECT_NO_THROW(DragLimiter{strict});
}

TEST(Device, ItCanStartFromAKnownOne) {
  const Device device =
      parse_device("{like: omega.3, name: mine, physical_damping: 0.3}", "arm.yaml");
  EXPECT_EQ(device.name, "mine");
  EXPECT_THAT(device.damping_ceiling, ElementsAre(30));
  EXPECT_EQ(limiter_options(device, LimiterMode::strict).damping,
            0.3 * Eigen::Matrix3d::Identity());
}

TEST(Device, ErrorsSayWhereAndWhat) {
  EXPECT_THAT(error_of("name: a\nphysical_dampening: 1"),
              AllOf(HasSubstr("arm.yaml:2"), HasSubstr("try physical_damping")));
  EXPECT_THAT(error_of("mass: 1"), HasSubstr("no name"));
  EXPECT_THAT(error_of("name: a\nmass: heavy"), AllOf(HasSubstr("mass"), HasSubstr("'heavy'")));
  EXPECT_THAT(error_of("name: a\nencoder_step: 0"), HasSubstr("above zero"));
  EXPECT_THAT(error_of("name: a\nmass: .nan"), HasSubstr("mass cannot be used"));
  EXPECT_THAT(error_of("name: a\nmass: [1, 2]"),
              HasSubstr("found 2 values, expected one value, or 3"));
  EXPECT_THAT(error_of("name: a\nmass: {x: 1}"), HasSubstr("mass cannot be used"));
  EXPECT_THAT(error_of("name: a\nmass: []"), HasSubstr("0 values"));
  EXPECT_THAT(error_of("name: a\naxes: joints"), HasSubstr("axis_count"));
  EXPECT_THAT(error_of("name: a\naxes: joints\naxis_count: 17"), HasSubstr("1 to 16"));
  EXPECT_THAT(error_of("name: a\naxis_count: 4"), HasSubstr("three axes"));
  EXPECT_THAT(error_of("name: a\naxes: wheels"), HasSubstr("'wheels'"));
  EXPECT_THAT(error_of("name: a\nname: b"), HasSubstr("twice"));
  EXPECT_THAT(error_of("like: omega\nname: b"), HasSubstr("'omega.3'"));
  EXPECT_THAT(error_of("- 1"), HasSubstr("describes no device"));
  EXPECT_THAT(error_of(""), HasSubstr("describes no device"));
  EXPECT_THAT(error_of("name: [unfinished"), HasSubstr("not YAML"));
}

TEST(Device, AFileIsReadAndAMissingOneIsNamed) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "vicinity_arm.yaml";
  std::ofstream(file) << "name: from a file\n";
  EXPECT_EQ(read_device(file).name, "from a file");
  EXPECT_EQ(find_device(file.string()).name, "from a file");
  EXPECT_EQ(find_device("falcon").name, "falcon");
  std::filesystem::remove(file);
  try {
    read_device(file);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("vicinity_arm.yaml"));
  }
}

}  // namespace
}  // namespace vicinity
