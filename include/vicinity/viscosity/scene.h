// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The workplace: which objects stand where, and how thick their layers are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "vicinity/geometry/error.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/layers/shaping_element.h"
#include "vicinity/mesh/placement.h"
#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/viscosity/coding.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/inner.h"

namespace vicinity {

/// A mesh on disk. Of its unit nothing is read from the file, where it states one either, so that
/// one must be stated here.
struct MeshFile {
  std::filesystem::path path;
  std::optional<LengthUnit> units;
};

/// One object. A mesh given in memory is in metres.
struct SceneObject {
  std::string name;
  std::variant<MeshFile, TriangleMesh> shape;
  Pose X_WO = Pose::Identity();
  double scale = 1;
  int m = 4;  ///< radius of the floating analyser zone, in voxels, 1..8
  int q = 6;  ///< number of ranks, 0..32
  LayerShape layers = LayerShape::sphere;
  BoundaryMethod boundary = BoundaryMethod::exact;
  InnerMethod inner = InnerMethod::winding;
  Coding coding{{32, 25, 20, 17, 15, 13}, 100};
};

/// Errors: throws Error, naming `where`, for an empty name, m, q, scale or pose out of range, and
/// as check_coding().
void check_object(const SceneObject& object, const std::string& where);

/// The error for a mesh file without a unit: says how large the object is read as mm, m and inches.
/// @param mesh  as it stands in its file
Error missing_unit(const TriangleMesh& mesh, const std::string& where);

/// The slave arm, for the run-time half.
struct SceneRobot {
  std::filesystem::path urdf;
  Pose X_WB = Pose::Identity();  ///< its base
  double points_per_m2 = 2000;
  std::vector<std::string> exclude;  ///< links that feel nothing
  std::string tool;                  ///< frame of the tool
};

/// A workplace: its objects, how finely it is seen, and the arm in it.
struct Scene {
  double voxel_size = 0.005;  ///< h [m]
  std::optional<Box> bounds;  ///< in W [m]; where absent, all objects with all their layers
  std::vector<SceneObject> objects;
  std::optional<SceneRobot> robot;
};

}  // namespace vicinity
