// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Points, directions, poses and boxes: the nouns every stage shares. SI units, double precision.
#pragma once

#include <Eigen/Geometry>

namespace vicinity {

/// Point or direction, shape (3,). A frame rides in the name: p_WR is point R seen from W.
using Vec3 = Eigen::Vector3d;

/// Rigid pose. X_WO places object O in the workspace W, so that p_WR = X_WO * p_OR.
using Pose = Eigen::Isometry3d;

/// Axis-aligned box with corners min() and max(); empty until a point is put in.
using Box = Eigen::AlignedBox3d;

/// Pose from a position [m] and roll, pitch, yaw [rad] about the fixed x, y and z axes, in that
/// order (the convention of URDF and SDF).
Pose pose_from_rpy(const Vec3& xyz, const Vec3& rpy);

/// Pose from a position [m] and a quaternion (x, y, z, w) of any non-zero length.
Pose pose_from_quaternion(const Vec3& xyz, const Eigen::Vector4d& xyzw);

}  // namespace vicinity
