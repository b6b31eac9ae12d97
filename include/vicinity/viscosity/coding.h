// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Viscosity of each rank: mu(n) (§5.2, §5.4).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vicinity {

/// rank -> viscosity [N·s/m³]. Values beyond an object's q are ignored.
struct Coding {
  std::vector<double> mu;  ///< mu[n-1] is the viscosity of rank n, >= 0 and finite
  double skin = 100;       ///< of boundary and inner voxels, >= 0 and finite

  /// Viscosity of rank n, 1-based; n must be at most mu.size().
  double of_rank(int n) const noexcept { return mu[static_cast<std::size_t>(n - 1)]; }

  /// Continuous mu = f(d) (eq. 3) for layers m voxels wide: straight lines through mu(n) at the
  /// near side of rank n, and through zero at the far side of rank q.
  /// @param distance_vox  distance from the surface, in voxels; below zero reads as zero
  double at_distance(double distance_vox, int m, int q) const noexcept;
};

/// Errors: throws Error, naming `where`, for fewer values than q, and for a value or a skin that is
/// not finite or below zero.
void check_coding(const Coding& coding, int q, const std::string& where);

/// q values of a named coding: "linear" (32, 29, ... 5) and "nonlinear" (32, 20, 13, 11, 10, 9, 8,
/// 0, 0, 0, 0) of the paper's table 2, "jnd" (from 32 down by the just noticeable ratio 1.34) or
/// "paper" (32, 25, 20, 17, 15, 13 of §5.2, the default). The first two go on below their last
/// value as they end: in steps of 3 down to zero, and in zeros. Errors: throws Error for another
/// name, and for "paper" with q above 6.
Coding named_coding(std::string_view name, int q);

}  // namespace vicinity
