// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "axis_matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vicinity/geometry/error.h"

namespace vicinity {

AxisMatrix checked_axis_matrix(const Eigen::MatrixXd& matrix, const std::string& where,
                               Definiteness definiteness) {
  const auto size = [&] {
    return std::to_string(matrix.rows()) + " x " + std::to_string(matrix.cols());
  };
  if (matrix.rows() != matrix.cols() || matrix.rows() == 0 || matrix.rows() > axis_capacity) {
    throw Error({.where = where,
                 .what = "the matrix has a wrong size",
                 .found = size(),
                 .expected = "square, with 1 to " + std::to_string(axis_capacity) + " axes"});
  }
  if (!matrix.allFinite()) {
    throw Error({.where = where,
                 .what = "the matrix holds a value that is not finite",
                 .expected = "numbers"});
  }
  const double largest = matrix.cwiseAbs().maxCoeff();
  const double asymmetry = (matrix - matrix.transpose()).cwiseAbs().maxCoeff();
  if (asymmetry > 1e-12 * largest) {
    throw Error({.where = where,
                 .what = "the matrix is not symmetric",
                 .found = "entries that differ by " + std::to_string(asymmetry)});
  }
  const double lowest = eigenvalue_bounds(matrix).lowest;
  const bool definite = definiteness == Definiteness::definite;
  if (definite ? !(lowest > 1e-11 * largest) : !(lowest >= -1e-11 * largest)) {
    throw Error({.where = where,
                 .what = definite ? "the matrix is not positive definite"
                                  : "the matrix is not positive semidefinite",
                 .found = "lowest eigenvalue " + std::to_string(lowest)});
  }
  return matrix;
}

EigenvalueBounds eigenvalue_bounds(AxisMatrix matrix) noexcept {
  constexpr int most_sweeps = 10;
  constexpr double near_enough = 1e-13;  // of the norm; the discs then reach no farther than that
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const Eigen::Index n = matrix.rows();

  // Scaled, so that squares neither overflow nor vanish. NaN fails every comparison.
  double size = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) {
      if (!std::isfinite(matrix(i, j))) return {-infinity, infinity};
      size = std::max(size, std::abs(matrix(i, j)));
    }
  }
  if (size == 0) return {};
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) matrix(j, i) = matrix(i, j) /= size;
  }

  const double norm = matrix.norm();
  int rotations = 0;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double off_diagonal = 0;
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = j + 1; i < n; ++i) off_diagonal += matrix(i, j) * matrix(i, j);
    }
    if (off_diagonal <= near_enough * near_enough * norm * norm) break;
    for (Eigen::Index p = 0; p < n; ++p) {
      for (Eigen::Index q = p + 1; q < n; ++q) {
        const double apq = matrix(q, p);
        if (apq == 0) continue;
        // The rotation that zeroes (p,q): tan of the smaller angle. Where the square overflows, it
        // is zero and the disc keeps the entry.
        const double cot_2 = (matrix(q, q) - matrix(p, p)) / (2 * apq);
        const double t = std::copysign(1, cot_2) / (std::abs(cot_2) + std::sqrt(1 + cot_2 * cot_2));
        const double c = 1 / std::sqrt(1 + t * t), s = t * c;
        for (Eigen::Index i = 0; i < n; ++i) {
          const double aip = matrix(i, p), aiq = matrix(i, q);
          matrix(i, p) = c * aip - s * aiq;
          matrix(i, q) = s * aip + c * aiq;
        }
        for (Eigen::Index i = 0; i < n; ++i) {
          const double api = matrix(p, i), aqi = matrix(q, i);
          matrix(p, i) = c * api - s * aqi;
          matrix(q, i) = s * api + c * aqi;
        }
        ++rotations;
      }
    }
  }

  EigenvalueBounds bounds{infinity, -infinity};
  for (Eigen::Index i = 0; i < n; ++i) {
    double radius = 0;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (j != i) radius += std::abs(matrix(i, j));
    }
    bounds.lowest = std::min(bounds.lowest, matrix(i, i) - radius);
    bounds.highest = std::max(bounds.highest, matrix(i, i) + radius);
  }
  // One rotation, computed and applied, errs by less than 8 roundings of the norm.
  const double cushion = 8 * (rotations + 1) * epsilon * norm;
  return {size * (bounds.lowest - cushion), size * (bounds.highest + cushion)};
}

}  // namespace vicinity
