// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "feel_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "drag_words.h"
#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"
#include "vicinity/teleop/device.h"

namespace vicinity::viewer {
namespace {

constexpr std::array known_keys = {"memory", "direction", "traversal", "device",
                                   "mode",   "coding",    "codings"};

void check_keys(const nlohmann::json& json) {
  for (const auto& [key, value] : json.items()) {
    const std::vector<std::string> known(known_keys.begin(), known_keys.end());
    if (std::ranges::find(known, key) != known.end()) continue;
    throw Error({.where = "feel",
                 .what = "there is no such key",
                 .found = "'" + key.substr(0, 100) + "'",
                 .hint = nearest_word(key, known)});
  }
}

const std::string& word_of(const char* key, const nlohmann::json& value) {
  if (!value.is_string()) {
    throw Error({.where = key, .what = "not a word", .found = value.type_name()});
  }
  return value.get_ref<const std::string&>();
}

std::vector<double> numbers_of(const nlohmann::json& value) {
  std::vector<double> numbers;
  for (const auto& each : value) {
    if (!each.is_number()) {
      throw Error({.where = "coding", .what = "not a number", .found = each.type_name()});
    }
    numbers.push_back(each.get<double>());
  }
  return numbers;
}

// null: as the field has it; a name; or values.
std::vector<double> coding_of(const nlohmann::json& value, const FieldObject& original) {
  if (value.is_null()) return original.coding.mu;
  if (value.is_string()) return named_coding(value.get<std::string>(), original.q).mu;
  if (value.is_array()) return numbers_of(value);
  throw Error({.where = "coding",
               .what = "not a coding",
               .found = value.type_name(),
               .expected = "a list of viscosities, a name, or null"});
}

}  // namespace

FeelWords feel_words(FeelWords now, const nlohmann::json& json, const std::string& own_device) {
  check_keys(json);
  const auto read = [&](const char* key, std::string& word) {
    if (json.contains(key)) word = word_of(key, json[key]);
  };
  read("memory", now.memory);
  read("direction", now.direction);
  read("traversal", now.traversal);
  read("mode", now.mode);
  if (json.contains("device")) {
    now.device = json["device"].is_null() ? std::string() : word_of("device", json["device"]);
    if (!now.device.empty() && now.device != own_device) (void)known_device(now.device);
  }
  return now;
}

TeleoperationOptions feel_options(TeleoperationOptions like, const FeelWords& words) {
  like.memory = named_memory(words.memory);
  like.direction = cli::direction_from(words.direction);
  like.traversal = cli::traversal_from(words.traversal);
  if (words.mode != "strict" && words.mode != "device") {
    throw Error({.where = "mode",
                 .what = "there is no such mode",
                 .found = "'" + words.mode + "'",
                 .expected = "strict or device"});
  }
  like.limiter.reset();
  if (!words.device.empty()) {
    const LimiterMode mode = words.mode == "strict" ? LimiterMode::strict : LimiterMode::device;
    like.limiter = limiter_options(find_device(words.device), mode);
  }
  return like;
}

std::vector<Coding> codings_from(const nlohmann::json& json, const ViscosityField& field,
                                 const ViscosityField& original) {
  std::vector<Coding> codings;
  const auto& objects = field.objects();
  for (std::size_t o = 0; o < objects.size(); ++o) {
    codings.push_back(objects[o].coding);
    if (!json.contains("coding")) continue;
    codings[o].mu = coding_of(json["coding"], original.objects()[o]);
    if (json["coding"].is_null()) codings[o].skin = original.objects()[o].coding.skin;
  }
  if (!json.contains("codings")) return codings;
  if (!json["codings"].is_object()) {
    throw Error(
        {.where = "codings", .what = "not by object", .found = json["codings"].type_name()});
  }
  for (const auto& [name, one] : json["codings"].items()) {
    const auto found =
        std::ranges::find_if(objects, [&](const FieldObject& each) { return each.name == name; });
    if (found == objects.end() || !one.is_object()) {
      std::vector<std::string> names;
      for (const FieldObject& object : objects) names.push_back(object.name);
      throw Error({.where = "codings",
                   .what = "there is no such object",
                   .found = "'" + name.substr(0, 100) + "'",
                   .hint = nearest_word(name, names)});
    }
    const auto o = static_cast<std::size_t>(found - objects.begin());
    if (one.contains("coding")) codings[o].mu = coding_of(one["coding"], original.objects()[o]);
    if (!one.contains("skin")) continue;
    if (!one["skin"].is_number()) throw Error({.where = name, .what = "its skin is not a number"});
    codings[o].skin = one["skin"].get<double>();
  }
  return codings;
}

nlohmann::ordered_json feel_json(const FeelWords& words, const ViscosityField& field) {
  nlohmann::ordered_json json{{"memory", words.memory},
                              {"direction", words.direction},
                              {"traversal", words.traversal},
                              {"device", nullptr},
                              {"mode", words.mode}};
  json["limiter"] =
      "none: drag as the field has it, and no promise that a device renders it stably";
  if (!words.device.empty()) {
    json["device"] = words.device;
    json["limiter"] = fmt::format("{} mode, device '{}'", words.mode, words.device);
  }
  json["codings"] = nlohmann::ordered_json::object();
  for (const FieldObject& object : field.objects()) {
    json["codings"][object.name] = {{"coding", object.coding.mu}, {"skin", object.coding.skin}};
  }
  const auto viscosities = field.viscosities();
  json["viscosity"] = std::vector<double>(viscosities.begin(), viscosities.end());
  return json;
}

}  // namespace vicinity::viewer
