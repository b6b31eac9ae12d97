// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Simple polygons in a plane: is it one, which way round, and cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vicinity {

using PlanePoint = std::array<double, 2>;

/// Area inside; negative for a clockwise outline.
double signed_area(const std::vector<PlanePoint>& outline);

/// Whether no two edges meet except neighbours in their shared corner. O(n²).
bool is_simple(const std::vector<PlanePoint>& outline);

/// Ear clipping of a simple, counter-clockwise polygon: n - 2 counter-clockwise triangles, none of
/// them degenerate even where corners lie on a straight edge. O(n³) at worst, n being tens.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<PlanePoint>& outline);

}  // namespace vicinity
