// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Reading a robot from a URDF file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vicinity/robot/robot_model.h"

namespace vicinity {

struct UrdfOptions {
  /// Folders that hold packages, or are one, searched for package://NAME/... after the folders
  /// above the URDF file.
  std::vector<std::filesystem::path> package_folders = {};
  /// Which of a link's two sets of geometries to take; the other one where it yields no surface.
  LinkGeometry::Role geometry = LinkGeometry::Role::collision;
};

/// A robot, and what was odd about its file: whole sentences, one for each oddity.
struct RobotLoad {
  RobotModel robot;
  std::vector<std::string> remarks;
};

/// Reads a URDF file and the meshes it names: STL, OBJ, PLY, DAE and whatever else read_mesh()
/// knows, in metres (DAE: in the unit the file states, its up axis not turned), and boxes,
/// cylinders, spheres and capsules. A mesh is found by package://, file:// or model:// address, or
/// by its path from the URDF's folder.
///
/// What a person would go on with is survived and remarked: a mesh that is missing, broken, open or
/// implausibly large; a shape that is not known; an axis that is not a unit vector (normalised) or
/// is zero (the joint is taken as fixed); a joint without limits, with reversed limits (swapped),
/// or whose limits leave zero out; a joint of type floating or planar (taken as fixed); a joint
/// that mimics none, or itself (moves by itself); links without surface, inertia or mass.
///
/// Errors: throws Error, with the line, for a file that cannot be opened, is no XML or no URDF (a
/// xacro file, say), or describes no tree: no link, two of the same name, a link that does not
/// exist or hangs on two joints, two roots, a loop; and for numbers of a joint that cannot be read.
RobotLoad read_urdf(const std::filesystem::path& path, const UrdfOptions& options = {});

/// As read_urdf(), from text. @param where  the file it stands for: named in errors, and its folder
/// is where relative mesh paths start
RobotLoad parse_urdf(std::string_view text, const std::filesystem::path& where,
                     const UrdfOptions& options = {});

}  // namespace vicinity
