// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A robot as a tree of links and joints, free of any file's syntax.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

/// How a joint moves. Mimic joints are of these types too: see Joint::multiplier.
enum class JointType {
  fixed,
  revolute,    ///< turns about its axis within limits [rad]
  continuous,  ///< turns about its axis without end [rad]
  prismatic,   ///< slides along its axis [m]
};

/// Infinite where nothing is stated.
struct JointLimits {
  double lower = -std::numeric_limits<double>::infinity();    ///< [rad] or [m]
  double upper = std::numeric_limits<double>::infinity();     ///< [rad] or [m]
  double velocity = std::numeric_limits<double>::infinity();  ///< [rad/s] or [m/s]
  double effort = std::numeric_limits<double>::infinity();    ///< [N·m] or [N]
};

/// One joint and where it hangs. Its frame J is fixed to the parent link P; at position zero the
/// frame of the link it moves coincides with J.
struct Joint {
  std::string name;
  JointType type = JointType::fixed;
  int parent = 0;                ///< link it hangs on
  Pose X_PJ = Pose::Identity();  ///< joint frame in the parent link
  Vec3 axis_J = Vec3::UnitX();   ///< unit vector, shape (3,); not used by a fixed joint

  /// Position = multiplier * q[coordinate] + offset. A joint that moves by itself has multiplier 1
  /// and offset 0; one that mimics shares the coordinate of the joint it follows. -1: no
  /// coordinate, it stays at `offset`.
  int coordinate = -1;
  double multiplier = 1, offset = 0;

  JointLimits limits;
};

/// Part of a link's surface.
struct LinkGeometry {
  enum class Role { collision, visual };
  Role role = Role::collision;
  TriangleMesh mesh = {};  ///< in the link's frame [m]
};

/// Mass of a link and how it is spread. Drag does not need it; simulated motion does.
struct LinkInertia {
  double mass = 0;               ///< > 0 [kg]
  Pose X_LC = Pose::Identity();  ///< centre of mass, and the axes that `about_centre` is in
  Eigen::Matrix3d about_centre = Eigen::Matrix3d::Zero();  ///< symmetric [kg·m²]
};

struct Link {
  std::string name;
  std::vector<LinkGeometry> geometries = {};  ///< none for a mere frame
  std::optional<LinkInertia> inertia =
      std::nullopt;  ///< absent where none, or no usable one, is stated
};

/// links[0] is the base; joints[i] moves links[i + 1] and hangs on a link before it, so that one
/// pass from front to back reaches every parent before its children, and one from back to front
/// every child before its parent.
struct RobotModel {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;
  /// The joint that q[c] belongs to, for each coordinate c, in the order the description names
  /// them.
  std::vector<int> coordinates;

  std::optional<int> find_link(std::string_view name) const noexcept;
  std::optional<int> find_joint(std::string_view name) const noexcept;
};

/// The link of that name. Errors: throws Error, with the nearest name, where there is none.
/// @param where  what asks for it
int link_named(const RobotModel& robot, const std::string& name, const std::string& where);

/// Errors: throws Error for a model that breaks a promise made above: joints that do not match the
/// links, a parent that does not come first, an axis that is not a unit vector, a coordinate that
/// does not exist, a number that is not finite.
void check(const RobotModel& robot);

}  // namespace vicinity
