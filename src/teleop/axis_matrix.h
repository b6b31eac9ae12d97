// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Symmetric matrices over the axes: checked once, and their eigenvalues enclosed every tick.
#pragma once

#include <string>

#include "vicinity/teleop/axes.h"

namespace vicinity {

enum class Definiteness { definite, semidefinite };

/// The matrix as it is. Errors: throws Error, which begins with `where`, for one that is empty,
/// larger than axis_capacity, not square, not finite, not symmetric, or not as definite as asked.
AxisMatrix checked_axis_matrix(const Eigen::MatrixXd& matrix, const std::string& where,
                               Definiteness definiteness);

/// Numbers between which every eigenvalue of a symmetric matrix lies.
struct EigenvalueBounds {
  double lowest = 0, highest = 0;
};

/// Guaranteed bounds, sharp to about 1e-12 of the largest eigenvalue.
///
/// Cyclic Jacobi rotations bring the matrix near to diagonal form; what they leave is enclosed by
/// Gershgorin's discs, and a cushion covers the rounding of the rotations. So the bounds hold
/// however far the rotations got, and their number can be limited.
/// Only the lower triangle is read. Errors: none; a matrix that is not finite gives infinite
/// bounds. Real-time: at most 10 sweeps of n(n-1)/2 rotations, in practice 4 to 6; no allocation.
EigenvalueBounds eigenvalue_bounds(AxisMatrix matrix) noexcept;

}  // namespace vicinity
