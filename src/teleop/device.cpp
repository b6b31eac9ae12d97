// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/device.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numeric>
#include <sstream>

#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"

namespace vicinity {
namespace {

// Ceilings and forces as CHAI3D ships them (maximum recommended linear damping, maximum
// linear force). The ceilings presume the toolkit's own velocity filter at 1 to 4 kHz. The makers
// publish no damping of their own: `strict` needs a measurement.
std::vector<Device> devices_of_public_toolkits() {
  const auto device = [](const char* name, double ceiling, std::optional<double> force) {
    Device d;
    d.name = name;
    d.damping_ceiling = {ceiling};
    d.force_limit = force;
    return d;
  };
  return {device("falcon", 20, 8.0),   device("lambda.7", 30, std::nullopt),
          device("omega.3", 30, 12.0), device("omega.6", 30, 12.0),
          device("omega.7", 30, 12.0), device("phantom omni", 5, 3.3),
          device("sigma.7", 30, 12.0), device("touch", 4, 3.3)};
}

// Nothing where there is no word.
std::string quoted(const std::string& word) { return word.empty() ? "" : "'" + word + "'"; }

const std::vector<std::string> keys{"like",
                                    "name",
                                    "axes",
                                    "axis_count",
                                    "mass",
                                    "physical_damping",
                                    "damping_ceiling",
                                    "encoder_step",
                                    "dry_friction",
                                    "sample_period",
                                    "force_limit",
                                    "torque_limits"};

// One file's text, and where in it we are.
class DeviceReader {
 public:
  DeviceReader(const YAML::Node& root, std::string where) : root_(root), where_(std::move(where)) {}

  Device read() const {
    check_keys();
    Device device;
    if (root_["like"]) device = known_device(text("like"));
    if (!root_["name"]) fail(root_, "the device has no name", "", "a line such as 'name: my arm'");
    device.name = text("name");
    if (root_["axes"]) device.axes = axes();
    if (device.axes == AxisKind::joints) {
      device.axis_count = joint_count();
    } else if (root_["axis_count"]) {
      fail(root_["axis_count"], "axis_count is for joints", text("axis_count"),
           "no axis_count: a handle has three axes");
    }
    read_list("mass", Zero::allowed, device, device.mass);
    read_list("physical_damping", Zero::allowed, device, device.physical_damping);
    read_list("damping_ceiling", Zero::refused, device, device.damping_ceiling);
    read_list("encoder_step", Zero::refused, device, device.encoder_step);
    read_list("dry_friction", Zero::allowed, device, device.dry_friction);
    read_list("torque_limits", Zero::refused, device, device.torque_limits);
    if (root_["sample_period"]) device.sample_period = number("sample_period");
    if (root_["force_limit"]) device.force_limit = number("force_limit");
    return device;
  }

 private:
  enum class Zero { allowed, refused };

  [[noreturn]] void fail(const YAML::Node& node, std::string what, std::string found,
                         std::string expected, std::string hint = {}) const {
    const int line = node.Mark().line;
    throw Error({.where = line < 0 ? where_ : where_ + ":" + std::to_string(line + 1),
                 .what = std::move(what),
                 .found = std::move(found),
                 .expected = std::move(expected),
                 .hint = std::move(hint)});
  }

  void check_keys() const {
    if (!root_.IsMap()) fail(root_, "this describes no device", "", "keys and values");
    std::vector<std::string> seen;
    for (const auto& entry : root_) {
      const auto key = entry.first.as<std::string>("");
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
        fail(entry.first, "a device has no such key", "'" + key + "'", "", nearest_word(key, keys));
      }
      if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
        fail(entry.first, "the key is there twice", "'" + key + "'", "one");
      }
      seen.push_back(key);
    }
  }

  std::string text(const char* key) const {
    const YAML::Node node = root_[key];
    if (!node.IsScalar() || node.Scalar().empty()) {
      fail(node, std::string(key) + " is not a word", "", "one value");
    }
    return node.Scalar();
  }

  AxisKind axes() const {
    const std::string word = text("axes");
    if (word == "cartesian") return AxisKind::cartesian;
    if (word == "joints") return AxisKind::joints;
    fail(root_["axes"], "no such kind of axes", "'" + word + "'", "cartesian or joints");
  }

  int joint_count() const {
    if (!root_["axis_count"]) {
      fail(root_["axes"], "a device with joints must say how many", "", "axis_count");
    }
    const int count = root_["axis_count"].as<int>(0);
    if (count < 1 || count > axis_capacity) {
      fail(root_["axis_count"], "axis_count cannot be used", text("axis_count"),
           "1 to " + std::to_string(axis_capacity));
    }
    return count;
  }

  double value(const YAML::Node& node, const char* key, Zero zero) const {
    const double number = node.IsScalar() ? node.as<double>(NAN) : NAN;
    if (std::isfinite(number) && (number > 0 || (number == 0 && zero == Zero::allowed))) {
      return number;
    }
    fail(node, std::string(key) + " cannot be used",
         node.IsScalar() ? "'" + node.Scalar() + "'" : "something that is no number",
         zero == Zero::allowed ? "a finite number, zero or more" : "a finite number above zero");
  }

  double number(const char* key) const { return value(root_[key], key, Zero::refused); }

  void read_list(const char* key, Zero zero, const Device& device,
                 std::vector<double>& values) const {
    const YAML::Node node = root_[key];
    const auto count = static_cast<std::size_t>(device.axis_count);
    if (node) {
      values.clear();
      if (node.IsSequence()) {
        for (const YAML::Node& entry : node) values.push_back(value(entry, key, zero));
      } else {
        values.push_back(value(node, key, zero));
      }
    }
    if (!node && values.empty()) return;
    if (values.size() != 1 && values.size() != count) {
      fail(node, std::string(key) + " does not fit the axes",
           std::to_string(values.size()) + " values",
           count == 1 ? "one value" : "one value, or " + std::to_string(count));
    }
  }

  const YAML::Node root_;
  std::string where_;
};

}  // namespace

std::span<const Device> known_devices() {
  static const std::vector<Device> devices = devices_of_public_toolkits();
  return devices;
}

const Device& known_device(std::string_view name) {
  std::vector<std::string> names;
  std::string list;
  for (const Device& device : known_devices()) {
    if (device.name == name) return device;
    names.push_back(device.name);
    list += (list.empty() ? "" : ", ") + device.name;
  }
  const std::string nearest = quoted(nearest_word(name, names));
  throw Error(
      {.where = "device",
       .what = "no device of this name is known",
       .found = "'" + std::string(name) + "'",
       .expected = "one of " + list,
       .hint = (nearest.empty() ? "" : nearest + ", or ") + "a file that describes your own"});
}

Device parse_device(const std::string& yaml, const std::string& where) {
  YAML::Node root;
  try {
    root = YAML::Load(yaml);
  } catch (const YAML::Exception& e) {
    throw Error({.where = where + ":" + std::to_string(e.mark.line + 1),
                 .what = "this is not YAML: " + e.msg});
  }
  return DeviceReader(root, where).read();
}

Device read_device(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream || !text) {
    throw Error({.where = file.string(), .what = "the file is empty or cannot be read"});
  }
  return parse_device(text.str(), file.string());
}

Device find_device(const std::string& name_or_file) {
  const std::filesystem::path path(name_or_file);
  const bool is_file = path.extension() == ".yaml" || path.extension() == ".yml";
  return is_file ? read_device(path) : known_device(name_or_file);
}

}  // namespace vicinity
