// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "scene_document.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "folder.h"
#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::viewer {
namespace {

constexpr std::string_view mesh_folder = "meshes/";

// What a plain scalar means in a scene file: a number, a truth, or a word.
nlohmann::ordered_json scalar(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;  // quoted
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole =
      error == std::errc{} && end == text.data() + text.size() && std::isfinite(number);
  if (!whole) return text;
  constexpr double largest_exact = 9e15;
  if (number == std::floor(number) && std::abs(number) < largest_exact) {
    return static_cast<std::int64_t>(number);
  }
  return number;
}

// Keys whose values are words, also where they look like numbers.
bool is_word(const std::string& key) {
  return key == "name" || key == "mesh" || key == "units" || key == "urdf" || key == "tool";
}

// read_scene() has read the same text before: it is no deeper and no larger than a scene.
nlohmann::ordered_json json_of(const YAML::Node& node) {
  if (node.IsScalar()) return scalar(node);
  if (node.IsSequence()) {
    auto list = nlohmann::ordered_json::array();
    for (const YAML::Node& each : node) list.push_back(json_of(each));
    return list;
  }
  if (!node.IsMap()) return nullptr;
  auto map = nlohmann::ordered_json::object();
  for (const auto& entry : node) {
    const std::string& key = entry.first.Scalar();
    const bool word = is_word(key) && entry.second.IsScalar();
    map[key] = word ? nlohmann::ordered_json(entry.second.Scalar()) : json_of(entry.second);
  }
  return map;
}

bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder) {
  return path.parent_path() == folder / "meshes" && is_plain_name(path.filename().string());
}

template <class Document, class Visit>
void each_mesh(Document& scene, const Visit& visit) {
  if (!scene.is_object() || !scene.contains("objects") || !scene["objects"].is_array()) return;
  for (auto& object : scene["objects"]) {
    if (object.is_object() && object.contains("mesh") && object["mesh"].is_string()) {
      visit(object["mesh"]);
    }
  }
}

// Lists of numbers, and of lists of numbers, stay on a line.
bool is_short(const nlohmann::ordered_json& json) {
  return std::all_of(json.begin(), json.end(), [](const nlohmann::ordered_json& each) {
    return each.is_primitive() || (each.is_array() && is_short(each));
  });
}

void emit(YAML::Emitter& out, const nlohmann::ordered_json& json, bool flow) {
  if (json.is_object() || json.is_array()) {
    const bool on_a_line = json.is_array() && is_short(json);
    if (on_a_line || flow) out << YAML::Flow;
    if (json.is_object()) {
      out << YAML::BeginMap;
      for (const auto& [key, value] : json.items()) {
        out << YAML::Key << key << YAML::Value;
        emit(out, value,
             flow || key == "pose" || key == "primitive" || key == "base" || key == "defaults");
      }
      out << YAML::EndMap;
    } else {
      out << YAML::BeginSeq;
      for (const auto& each : json) emit(out, each, on_a_line || flow);
      out << YAML::EndSeq;
    }
  } else if (json.is_string()) {
    out << json.get<std::string>();
  } else if (json.is_number_float()) {
    out << json.dump();  // shortest digits that read the same
  } else if (json.is_null()) {
    out << YAML::Null;
  } else {
    out << json.dump();
  }
}

}  // namespace

SceneDocument read_document(const std::filesystem::path& path,
                            const std::filesystem::path& folder) {
  (void)read_scene(path);  // refuses, with its line, what is no scene
  const YAML::Node root = YAML::LoadFile(path.string());
  SceneDocument document{
      .name = path.filename().string(), .scene = json_of(root), .robot = nullptr};
  const auto beside = std::filesystem::absolute(path).parent_path();
  const auto home = std::filesystem::absolute(folder).lexically_normal();
  const auto absolute = [&](const std::string& text) { return (beside / text).lexically_normal(); };
  each_mesh(document.scene, [&](nlohmann::ordered_json& mesh) {
    const auto at = absolute(mesh.template get<std::string>());
    mesh = lies_in(at, home) ? std::string(mesh_folder) + at.filename().string() : at.string();
  });
  if (document.scene.contains("robot")) {
    document.robot = document.scene["robot"];
    document.scene.erase("robot");
    if (document.robot.contains("urdf")) {
      document.robot["urdf"] = absolute(document.robot["urdf"].get<std::string>()).string();
    }
  }
  return document;
}

std::set<std::string> mesh_paths(const nlohmann::ordered_json& scene) {
  std::set<std::string> paths;
  each_mesh(scene,
            [&](const nlohmann::ordered_json& mesh) { paths.insert(mesh.get<std::string>()); });
  return paths;
}

Scene scene_of(const nlohmann::ordered_json& scene, const std::filesystem::path& folder,
               const std::set<std::string>& allowed) {
  for (const std::string& path : mesh_paths(scene)) {
    const bool uploaded =
        path.starts_with(mesh_folder) && is_plain_name(path.substr(mesh_folder.size()));
    if (uploaded || allowed.contains(path)) continue;
    throw Error({.where = "mesh '" + path.substr(0, 200) + "'",
                 .what = "a page may only name meshes that it has uploaded",
                 .expected = "meshes/NAME, or a path that the server named itself"});
  }
  nlohmann::ordered_json built = scene;
  if (built.is_object()) built.erase("robot");
  // JSON with blanks is YAML too.
  return parse_scene(built.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace),
                     folder, "the scene");
}

std::string yaml_of(const SceneDocument& document) {
  nlohmann::ordered_json all = document.scene;
  if (!document.robot.is_null()) all["robot"] = document.robot;
  YAML::Emitter out;
  emit(out, all, false);
  return std::string(out.c_str()) + "\n";
}

}  // namespace vicinity::viewer
