// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <system_error>
#include <vector>

#include "vicinity/geometry/error.h"

namespace vicinity::viewer {
namespace {

constexpr std::size_t longest_name = 100;
// More than a person can choose from.
constexpr std::size_t most_listed = 1000;
constexpr std::array scene_endings = {".yaml", ".yml"};
constexpr std::array field_endings = {".vicinity"};
constexpr std::array mesh_endings = {".stl", ".obj", ".ply", ".gltf",
                                     ".glb", ".dae", ".3mf", ".fbx"};
constexpr std::array recording_endings = {".csv"};

std::string ending_of(const std::string& name) {
  std::string ending = std::filesystem::path(name).extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return ending;
}

bool ends_as(const std::string& name, std::span<const char* const> endings) {
  const std::string ending = ending_of(name);
  return std::ranges::any_of(endings, [&](const char* each) { return ending == each; });
}

const std::string& checked(const std::string& name, const char* what,
                           std::span<const char* const> endings) {
  if (is_plain_name(name) && ends_as(name, endings)) return name;
  throw Error({.where = "'" + name.substr(0, longest_name) + "'",
               .what = fmt::format("not a name for a {}", what),
               .expected = fmt::format("letters, digits, '.', '_', '-' and space, at most {}, with "
                                       "the ending {}",
                                       longest_name, fmt::join(endings, ", "))});
}

void add_names(const std::filesystem::path& folder, std::span<const char* const> endings,
               std::vector<std::string>& names) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (names.size() < most_listed && is_plain_name(name) && ends_as(name, endings) &&
        entry.is_regular_file(error)) {
      names.push_back(name);
    }
  }
  std::ranges::sort(names);
}

}  // namespace

bool is_plain_name(std::string_view name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-' || c == ' ';
  };
  return !name.empty() && name.size() <= longest_name && name.front() != '.' &&
         name.front() != ' ' && std::ranges::all_of(name, is_plain);
}

std::filesystem::path Folder::scene(const std::string& name) const {
  return path_ / checked(name, "scene", scene_endings);
}

std::filesystem::path Folder::field(const std::string& name) const {
  return path_ / checked(name, "field", field_endings);
}

std::filesystem::path Folder::mesh(const std::string& name) const {
  return path_ / "meshes" / checked(name, "mesh", mesh_endings);
}

std::filesystem::path Folder::recording(const std::string& name) const {
  return path_ / "recordings" / checked(name, "recording", recording_endings);
}

std::filesystem::path Folder::any(const std::string& name) const {
  if (ends_as(name, recording_endings)) return recording(name);
  if (ends_as(name, scene_endings)) return scene(name);
  if (ends_as(name, field_endings)) return field(name);
  return mesh(name);
}

std::filesystem::path Folder::scratch() {
  std::error_code error;
  for (const char* inner : {"meshes", "recordings"}) {
    std::filesystem::create_directories(path_ / inner, error);
    if (error) {
      throw Error({.where = path_.string(),
                   .what = "the folder cannot be made",
                   .found = error.message(),
                   .hint = "another --folder"});
    }
  }
  return path_ / fmt::format(".coming-{}-{}", getpid(), scratch_files_.fetch_add(1));
}

void Folder::place(const std::filesystem::path& scratch, const std::filesystem::path& at) const {
  std::error_code error;
  std::filesystem::rename(scratch, at, error);
  if (error) {
    throw Error({.where = at.string(), .what = "cannot be written", .found = error.message()});
  }
}

nlohmann::ordered_json Folder::list(const std::vector<std::string>& more_recordings) const {
  std::vector<std::string> scenes, meshes, recordings = more_recordings, fields;
  add_names(path_, scene_endings, scenes);
  add_names(path_ / "meshes", mesh_endings, meshes);
  add_names(path_ / "recordings", recording_endings, recordings);
  add_names(path_, field_endings, fields);
  return {{"scenes", scenes}, {"meshes", meshes}, {"recordings", recordings}, {"fields", fields}};
}

}  // namespace vicinity::viewer
