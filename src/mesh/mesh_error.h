// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What every mesh reader refuses, said the same way.
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>

#include "vicinity/geometry/vec3.h"

namespace vicinity {

/// Beyond this a coordinate is damage, not a workplace: 1000 km where the unit is mm.
inline constexpr double largest_coordinate = 1e9;

/// False for NaN too, which compares as false.
inline bool is_sane(const Vec3& vertex) noexcept {
  const auto sane = [](double x) { return std::abs(x) <= largest_coordinate; };
  return bool(sane(vertex.x()) & sane(vertex.y()) & sane(vertex.z()));
}

/// Throws Error for a vertex that is not sane. `place` names the triangle or line.
[[noreturn]] void throw_insane(const std::filesystem::path& path, const std::string& place,
                               const Vec3& vertex);

/// Throws Error for a file without a triangle.
[[noreturn]] void throw_no_triangle(const std::filesystem::path& path);

/// The size of a file that can be opened and read.
/// Errors: throws Error for a folder, a device, a missing or an unreadable file.
std::size_t readable_size(const std::filesystem::path& path);

}  // namespace vicinity
