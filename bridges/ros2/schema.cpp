// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "ros2/schema.h"

#include <fmt/format.h>

#include <algorithm>

#include "ros2/sha256.h"

namespace vicinity::ros2 {
namespace {

// A list without a bound is this far from its elements.
constexpr int unbounded_list = 144;

// "std_msgs/msg/Header" -> "std_msgs/Header"; plain types stay.
std::string short_name(std::string_view type) {
  std::string name(type);
  const std::size_t middle = name.find("/msg/");
  return middle == std::string::npos ? name : name.erase(middle, 4);
}

// As Python's json.dumps() writes it: that is what ROS 2 hashes.
std::string json_of(const TypeDescription& type) {
  std::string fields;
  for (const FieldDescription& field : type.fields) {
    if (!fields.empty()) fields += ", ";
    fields += fmt::format(
        R"({{"name": "{}", "type": {{"type_id": {}, "capacity": 0, "string_capacity": 0, )"
        R"("nested_type_name": "{}"}}}})",
        field.name, field.type_id + (field.list ? unbounded_list : 0),
        field.type_id == 1 ? field.type : "");
  }
  return fmt::format(R"({{"type_name": "{}", "fields": [{}]}})", type.type, fields);
}

}  // namespace

std::string schema_text(const Description& description) {
  std::string text;
  for (const TypeDescription& type : description) {
    if (&type != &description.front()) {
      text += std::string(80, '=') + "\nMSG: " + short_name(type.type) + "\n";
    }
    for (const FieldDescription& field : type.fields) {
      text += short_name(field.type) + (field.list ? "[] " : " ") + field.name + "\n";
    }
  }
  return text;
}

std::string type_hash(const Description& description) {
  std::string referenced;
  for (std::size_t n = 1; n < description.size(); ++n) {
    if (n > 1) referenced += ", ";
    referenced += json_of(description[n]);
  }
  return "RIHS01_" + sha256_hex(fmt::format(
                         R"({{"type_description": {}, "referenced_type_descriptions": [{}]}})",
                         json_of(description.front()), referenced));
}

std::string dds_type_name(std::string_view type) {
  std::string name;
  for (const char c : type) name += c == '/' ? std::string("::") : std::string(1, c);
  return name.insert(name.rfind("::") + 2, "dds_::") + "_";
}

bool Describer::known(std::string_view type) const {
  return std::ranges::any_of(types_, [&](const auto& each) { return each.type == type; });
}

std::string_view Describer::plain_type(int type_id) {
  switch (type_id) {
    case 3:
      return "uint8";
    case 6:
      return "int32";
    case 7:
      return "uint32";
    case 9:
      return "uint64";
    case 10:
      return "float32";
    case 11:
      return "float64";
    case 15:
      return "bool";
    case 16:
      return "byte";
    case 17:
      return "string";
    default:
      return "";
  }
}

Description Describer::sorted() && {
  std::sort(types_.begin() + 1, types_.end(),
            [](const auto& a, const auto& b) { return a.type < b.type; });
  return std::move(types_);
}

}  // namespace vicinity::ros2
