// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Blue-noise samples of one surface, with the area each of them stands for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vicinity/geometry/vec3.h"

namespace vicinity {

/// Corners of one triangle [m].
using Corners = std::array<Vec3, 3>;

double area_of(const Corners& triangle) noexcept;

struct SurfaceSamples {
  std::vector<Eigen::Vector3f> points;
  std::vector<double> shares;  ///< they add up to the area of all triangles [m²]
};

/// @param triangles  in any order and of any winding; some of them with an area
/// @param count      how many samples, >= 1
SurfaceSamples sample_surface(std::vector<Corners> triangles, std::size_t count,
                              std::uint64_t seed);

}  // namespace vicinity
