// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a message is made of, as text for recordings and as the hash that ROS 2 compares.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ros2/cdr.h"

namespace vicinity::ros2 {

/// One field: of a plain type or a string, or of another message.
struct FieldDescription {
  std::string name;
  std::string_view type;  ///< "float64", or a message: "std_msgs/msg/Header"
  int type_id = 0;        ///< as in type_description_interfaces; 1: a message
  bool list = false;
};

struct TypeDescription {
  std::string_view type;
  std::vector<FieldDescription> fields;
};

/// First the message itself, then all that it refers to, sorted by name.
using Description = std::vector<TypeDescription>;

/// As in a .msg file, what it refers to behind it: the schema encoding "ros2msg" of MCAP.
std::string schema_text(const Description& description);

/// "RIHS01_" and the SHA-256 of the type description as ROS 2 writes it in JSON (REP 2016).
std::string type_hash(const Description& description);

/// "sensor_msgs/msg/JointState" -> "sensor_msgs::msg::dds_::JointState_"
std::string dds_type_name(std::string_view type);

/// Builds a description by looking at a message's fields.
class Describer {
 public:
  template <class Message>
  static Description of() {
    Describer describer;
    describer.add<Message>();
    return std::move(describer).sorted();
  }

 private:
  template <class T>
  static constexpr int type_id() {
    if constexpr (std::is_same_v<T, std::uint8_t>) return 3;
    if constexpr (std::is_same_v<T, std::int32_t>) return 6;
    if constexpr (std::is_same_v<T, std::uint32_t>) return 7;
    if constexpr (std::is_same_v<T, std::uint64_t>) return 9;
    if constexpr (std::is_same_v<T, float>) return 10;
    if constexpr (std::is_same_v<T, double>) return 11;
    if constexpr (std::is_same_v<T, bool>) return 15;
    if constexpr (std::is_same_v<T, std::byte>) return 16;
    if constexpr (std::is_same_v<T, std::string>) return 17;
    return 1;
  }

  struct Fields {
    Describer& describer;
    std::vector<FieldDescription>& fields;

    template <class T>
    void operator()(const char* name, const T&) {
      if constexpr (is_list<T>) {
        add<typename T::value_type>(name, true);
      } else {
        add<T>(name, false);
      }
    }
    template <class T>
    void add(const char* name, bool list) {
      constexpr int id = type_id<T>();
      std::string_view type = plain_type(id);
      if constexpr (id == 1) {
        type = T::type;
        describer.add<T>();
      }
      fields.push_back({.name = name, .type = type, .type_id = id, .list = list});
    }
  };

  template <class Message>
  void add() {
    if (known(Message::type)) return;
    const std::size_t place = types_.size();
    types_.push_back({.type = Message::type, .fields = {}});
    std::vector<FieldDescription> fields;
    const Message message;
    Message::fields(message, Fields{*this, fields});
    types_[place].fields = std::move(fields);
  }

  bool known(std::string_view type) const;
  static std::string_view plain_type(int type_id);
  Description sorted() &&;

  Description types_;
};

}  // namespace vicinity::ros2
