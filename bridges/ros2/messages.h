// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// ROS 2's messages, as far as we speak them: each a struct that can list its fields.
///
/// fields() is the one place that says what is in a message and in which order. Bytes (cdr.h),
/// the schema in a recording and the type hash on the wire (schema.h) are all made from it.
/// The listings follow the public definitions of ROS 2 Jazzy; tests hold them against the hashes
/// that ROS 2 itself generates. Units and meanings are those of the definitions: SI, and a header's
/// frame is what the numbers are in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vicinity::ros2 {

struct Time {
  static constexpr std::string_view type = "builtin_interfaces/msg/Time";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("sec", self.sec);
    visit("nanosec", self.nanosec);
  }
};

struct Duration {
  static constexpr std::string_view type = "builtin_interfaces/msg/Duration";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("sec", self.sec);
    visit("nanosec", self.nanosec);
  }
};

struct Header {
  static constexpr std::string_view type = "std_msgs/msg/Header";
  Time stamp;
  std::string frame_id;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("stamp", self.stamp);
    visit("frame_id", self.frame_id);
  }
};

struct Float64 {
  static constexpr std::string_view type = "std_msgs/msg/Float64";
  double data = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("data", self.data);
  }
};

struct ColorRGBA {
  static constexpr std::string_view type = "std_msgs/msg/ColorRGBA";
  float r = 0, g = 0, b = 0, a = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("r", self.r);
    visit("g", self.g);
    visit("b", self.b);
    visit("a", self.a);
  }
};

/// A list that is empty is one that the sender does not have.
struct JointState {
  static constexpr std::string_view type = "sensor_msgs/msg/JointState";
  Header header;
  std::vector<std::string> name;
  std::vector<double> position, velocity, effort;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("header", self.header);
    visit("name", self.name);
    visit("position", self.position);
    visit("velocity", self.velocity);
    visit("effort", self.effort);
  }
};

struct Vector3 {
  static constexpr std::string_view type = "geometry_msgs/msg/Vector3";
  double x = 0, y = 0, z = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
  }
};

struct Point {
  static constexpr std::string_view type = "geometry_msgs/msg/Point";
  double x = 0, y = 0, z = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
  }
};

struct Quaternion {
  static constexpr std::string_view type = "geometry_msgs/msg/Quaternion";
  double x = 0, y = 0, z = 0, w = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
    visit("w", self.w);
  }
};

struct Pose {
  static constexpr std::string_view type = "geometry_msgs/msg/Pose";
  Point position;
  Quaternion orientation;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("position", self.position);
    visit("orientation", self.orientation);
  }
};

/// Force and torque at the origin of a frame, in its axes.
struct Wrench {
  static constexpr std::string_view type = "geometry_msgs/msg/Wrench";
  Vector3 force, torque;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("force", self.force);
    visit("torque", self.torque);
  }
};

struct WrenchStamped {
  static constexpr std::string_view type = "geometry_msgs/msg/WrenchStamped";
  Header header;
  Wrench wrench;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("header", self.header);
    visit("wrench", self.wrench);
  }
};

struct Transform {
  static constexpr std::string_view type = "geometry_msgs/msg/Transform";
  Vector3 translation;
  Quaternion rotation;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("translation", self.translation);
    visit("rotation", self.rotation);
  }
};

struct TransformStamped {
  static constexpr std::string_view type = "geometry_msgs/msg/TransformStamped";
  Header header;
  std::string child_frame_id;
  Transform transform;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("header", self.header);
    visit("child_frame_id", self.child_frame_id);
    visit("transform", self.transform);
  }
};

struct TFMessage {
  static constexpr std::string_view type = "tf2_msgs/msg/TFMessage";
  std::vector<TransformStamped> transforms;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("transforms", self.transforms);
  }
};

struct KeyValue {
  static constexpr std::string_view type = "diagnostic_msgs/msg/KeyValue";
  std::string key, value;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("key", self.key);
    visit("value", self.value);
  }
};

struct DiagnosticStatus {
  static constexpr std::string_view type = "diagnostic_msgs/msg/DiagnosticStatus";
  static constexpr std::byte ok{0}, warn{1}, error{2}, stale{3};
  std::byte level = ok;
  std::string name, message, hardware_id;
  std::vector<KeyValue> values;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("level", self.level);
    visit("name", self.name);
    visit("message", self.message);
    visit("hardware_id", self.hardware_id);
    visit("values", self.values);
  }
};

struct DiagnosticArray {
  static constexpr std::string_view type = "diagnostic_msgs/msg/DiagnosticArray";
  Header header;
  std::vector<DiagnosticStatus> status;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("header", self.header);
    visit("status", self.status);
  }
};

}  // namespace vicinity::ros2
