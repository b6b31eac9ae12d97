// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A scene file as a document: YAML for people, JSON for the page, and what of it may be built.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "vicinity/viscosity/scene.h"

namespace vicinity::viewer {

/// A scene as text says it, key by key.
struct SceneDocument {
  std::string name;              ///< "cell.yaml"; empty: it has none yet
  nlohmann::ordered_json scene;  ///< without its robot; paths of meshes as mesh_paths()
  nlohmann::ordered_json robot;  ///< null where it has none; its urdf absolute
};

/// Reads a scene file that read_scene() can read too. Paths of meshes become "meshes/NAME" for
/// those in `folder`, and absolute for all others. Errors: as read_scene().
SceneDocument read_document(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Paths of the meshes in a document, as they stand in it.
std::set<std::string> mesh_paths(const nlohmann::ordered_json& scene);

/// The scene that a page's JSON describes.
/// @param folder   what "meshes/NAME" is relative to
/// @param allowed  other paths of meshes: no file of this machine is read because a page names it
/// Errors: as parse_scene(), and for a mesh elsewhere.
Scene scene_of(const nlohmann::ordered_json& scene, const std::filesystem::path& folder,
               const std::set<std::string>& allowed);

/// A scene file for people: short lists on one line, everything else on lines of its own.
std::string yaml_of(const SceneDocument& document);

}  // namespace vicinity::viewer
