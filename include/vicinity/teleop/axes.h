// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Vectors and matrices over the axes of a device: its joints, or x, y and z of its handle.
#pragma once

#include <Eigen/Core>

namespace vicinity {

/// What the axes of a device are.
enum class AxisKind {
  cartesian,  ///< x, y, z of the handle: [m], [N], [N·s/m], [kg]
  joints,  ///< one for each joint: [rad] (or [m] where it slides), [N·m], [N·m·s/rad], [kg·m²]
};

/// Axes that the run-time half can hold. Two arms of a dual-arm master are 14.
inline constexpr int axis_capacity = 16;

/// Values over n <= axis_capacity axes that never touch the heap.
using AxisVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, axis_capacity, 1>;
using AxisMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, axis_capacity, axis_capacity>;

/// How the run-time half takes vectors and matrices. Hand it something stored: an unevaluated
/// expression (-v, A * B) would be evaluated onto the heap on the way in.
using AxisVectorView = Eigen::Ref<const Eigen::VectorXd>;
using AxisMatrixView = Eigen::Ref<const Eigen::MatrixXd>;

}  // namespace vicinity
