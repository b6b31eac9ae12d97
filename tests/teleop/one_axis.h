// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Vectors and matrices of a single axis.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace vicinity {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

inline Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }
inline Eigen::MatrixXd scalar(double value) { return Eigen::MatrixXd::Constant(1, 1, value); }

}  // namespace vicinity
