// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What the <visual> and <collision> elements of a URDF say: shapes and meshes as triangles.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/robot/urdf_file.h"
#include "xml_element.h"

namespace vicinity {

/// Attribute of numbers, or `otherwise` where there is none.
/// Errors: throws Error, at `where` (may be empty), for anything but that many finite numbers.
double read_number(const XmlElement& element, const char* attribute, double otherwise,
                   const std::string& where);
Vec3 read_triple(const XmlElement& element, const char* attribute, const Vec3& otherwise,
                 const std::string& where);

/// Pose of an element's <origin>; the identity where there is none. Errors: as read_number().
Pose read_origin(const XmlElement& element, const std::string& where);

/// Reads the geometries of one robot, each mesh file once.
class UrdfGeometry {
 public:
  UrdfGeometry(const std::filesystem::path& urdf, const UrdfOptions& options,
               std::vector<std::string>& remarks)
      : urdf_(urdf), options_(options), remarks_(remarks) {}

  /// Triangles of a <visual> or <collision> element in the frame of its link [m]; nothing, and a
  /// remark why, where there is no surface.
  std::optional<TriangleMesh> read(const XmlElement& part, const std::string& link);

 private:
  TriangleMesh read_shape(const XmlElement& geometry, const std::string& where);
  TriangleMesh read_mesh_element(const XmlElement& element, const std::string& where);
  const TriangleMesh& read_mesh_file(const std::filesystem::path& path, const std::string& where);
  std::filesystem::path find_mesh(const std::string& address) const;

  const std::filesystem::path& urdf_;
  const UrdfOptions& options_;
  std::vector<std::string>& remarks_;
  std::map<std::filesystem::path, TriangleMesh> files_;  // as read, in metres
};

}  // namespace vicinity
