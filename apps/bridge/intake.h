// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What came over the wire, judged: one state of our arm, or why it is none.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ros2/messages.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/teleop/axes.h"

namespace vicinity::bridge {

/// Whether there is a state to tick with. What it does not see, the tick does: a doubled message
/// is `time stood still` there, one out of order `time ran backwards`, one that was lost
/// `deadline missed`, NaN `not finite`.
enum class Heard : std::uint8_t {
  state,          ///< a state of our arm, for the tick
  no_field,       ///< a state of our arm, but no field has come yet
  nothing_yet,    ///< no joint state has come since the start
  silence,        ///< none for longer than the loop allows
  late,           ///< it was under way for much longer than the quickest
  another_robot,  ///< a joint of ours is not named in it, others are; or none, and nobody named any
  malformed,      ///< no joint state, or lists that do not fit together
};

/// "state", "nothing yet", ...
const char* to_string(Heard heard) noexcept;

struct ArmSample {
  Heard heard = Heard::nothing_yet;
  ros2::Time stamp;   ///< the sender's; arrival, where it does not stamp
  double time_s = 0;  ///< the same, since the first one [s]
  AxisVector q, qd;   ///< shape (joints,); of no meaning unless `state`
  bool has_velocities = false;
  Pose X_WB = Pose::Identity();
};

/// When a message came.
struct Arrival {
  std::int64_t since_1970_ns = 0;
  std::int64_t monotonic_ns = 0;  ///< by a clock that nobody sets
};

/// For one thread. Not real-time.
class Intake {
 public:
  /// A message that was under way for so much longer than the quickest of the last seconds says
  /// where the arm was, not where it is [s].
  static constexpr double latest_s = 0.05;

  Intake(const RobotModel& robot, const Pose& X_WB);

  /// @param bytes  a sensor_msgs/msg/JointState in CDR
  /// @return nothing where it names no joint of ours, and others have: it is another device's, on
  ///         the same topic
  std::optional<ArmSample> joint_state(std::span<const std::byte> bytes, const Arrival& arrived);

  /// Takes the transform from `world` to the robot's base link, where the message holds it; false
  /// where it holds one that is none (not finite, no rotation) or cannot be read.
  bool transforms(std::span<const std::byte> bytes, const std::string& world);

 private:
  // The two quickest ways of some seconds. The second counts: a single stamp may be wrong.
  struct Quickest {
    static constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();
    std::int64_t first = none, second = none;
  };

  bool is_late(std::int64_t sent_ns, std::int64_t arrived_ns);
  void find_joints();

  std::vector<std::string> joints_;
  std::string base_link_;
  Pose X_WB_;
  ros2::JointState state_;
  std::vector<std::string> names_;   // of the last message
  std::vector<std::size_t> places_;  // of our joints in it, as far as they are
  bool started_ = false;
  std::int64_t first_ns_ = 0, last_ns_ = 0;  // stamps
  std::int64_t window_begin_ns_ = 0;
  Quickest quickest_, quickest_before_;  // of this window, and of the one before
};

}  // namespace vicinity::bridge
