// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Where our messages are found, on the wire and in a recording.
#pragma once

#include <string>
#include <string_view>

namespace vicinity::ros2::topic {

// What comes in, and what is everybody's.
inline constexpr std::string_view joint_states = "/joint_states";
inline constexpr std::string_view tf = "/tf", tf_static = "/tf_static";
inline constexpr std::string_view diagnostics = "/diagnostics";

// What is ours.
inline constexpr std::string_view joint_efforts = "/vicinity/joint_efforts";
inline constexpr std::string_view wrench = "/vicinity/wrench";
inline constexpr std::string_view master_force = "/vicinity/master_force";        ///< [N]
inline constexpr std::string_view reason_distance = "/vicinity/reason_distance";  ///< [m]
inline constexpr std::string_view speed_scale = "/vicinity/speed_scale";          ///< 0..1
inline constexpr std::string_view markers = "/vicinity/markers";
inline constexpr std::string_view layers = "/vicinity/layers";

/// "/joint_states" -> "rt/joint_states", as ROS 2 calls a topic on the wire.
inline std::string on_the_wire(std::string_view topic) { return "rt" + std::string(topic); }

}  // namespace vicinity::ros2::topic
