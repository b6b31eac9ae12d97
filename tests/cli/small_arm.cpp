// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "small_arm.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace vicinity::cli_test {

const char* const small_arm = R"(<robot name="small_arm">
  <link name="foot"/>
  <link name="upper">
    <collision><origin xyz="0.0613 0 0"/><geometry><box size="0.1226 0.0213 0.0213"/></geometry></collision>
  </link>
  <link name="lower">
    <collision><origin xyz="0.0513 0 0"/><geometry><box size="0.1026 0.0193 0.0193"/></geometry></collision>
  </link>
  <link name="finger">
    <collision><origin xyz="0.0307 0 0"/><geometry><box size="0.0614 0.0113 0.0113"/></geometry></collision>
  </link>
  <joint name="turn" type="continuous">
    <parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="bend" type="revolute">
    <parent link="upper"/><child link="lower"/><origin xyz="0.1226 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" velocity="3" effort="5"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="lower"/><child link="finger"/><origin xyz="0.0726 0 0"/><axis xyz="1 0 0"/>
    <limit lower="-0.1" upper="0.1" velocity="1" effort="50"/>
  </joint>
</robot>
)";

const char* const small_arm_base = "-0.12,-0.22,0.02,0,0,-0.3";

Pose small_arm_X_WB() { return pose_from_rpy({-0.12, -0.22, 0.02}, {0, 0, -0.3}); }

namespace {
const Vec3 a(0.9, -0.3, -0.02), b(-0.8, 0.6, 0.05), c(0.9, -0.5, -0.03);
}

Vec3 parabola(double t) { return a + b * t + c * t * t; }
Vec3 parabola_velocity(double t) { return b + 2 * c * t; }

std::string log_of(const Motion& motion, const std::vector<double>& times) {
  std::ostringstream text;
  text << std::setprecision(17) << "t,turn,bend,slide\n";
  for (const double t : times) {
    const Vec3 q = motion(t);
    text << t << ',' << q.x() << ',' << q.y() << ',' << q.z() << '\n';
  }
  return text.str();
}

std::vector<double> every(double rate, double end) {
  std::vector<double> times;
  for (int k = 0; k <= std::lround(end * rate); ++k) times.push_back(k / rate);
  return times;
}

}  // namespace vicinity::cli_test
