// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

/// One edge length triple in the unit that keeps its largest edge readable: mm below a metre.
std::string readable(const Vec3& size_in_metres) {
  const bool small = size_in_metres.maxCoeff() < 1.0;
  const Vec3 size = small ? Vec3(size_in_metres * 1e3) : size_in_metres;
  return fmt::format("{:.3g} x {:.3g} x {:.3g} {}", size.x(), size.y(), size.z(),
                     small ? "mm" : "m");
}

}  // namespace

double metres_per(LengthUnit unit) noexcept {
  switch (unit) {
    case LengthUnit::millimetre:
      return 0.001;
    case LengthUnit::centimetre:
      return 0.01;
    case LengthUnit::inch:
      return 0.0254;
    case LengthUnit::metre:
      break;
  }
  return 1.0;
}

std::optional<LengthUnit> length_unit(std::string_view word) noexcept {
  if (word == "mm") return LengthUnit::millimetre;
  if (word == "cm") return LengthUnit::centimetre;
  if (word == "m") return LengthUnit::metre;
  if (word == "in" || word == "inch" || word == "inches") return LengthUnit::inch;
  return std::nullopt;
}

std::string size_in_units(const Box& bounds) {
  if (bounds.isEmpty()) return "nothing";
  const Vec3 size = bounds.sizes();
  return fmt::format("{} if the unit is mm; {} if m; {} if inches",
                     readable(size * metres_per(LengthUnit::millimetre)),
                     readable(size * metres_per(LengthUnit::metre)),
                     readable(size * metres_per(LengthUnit::inch)));
}

TriangleMesh place(TriangleMesh mesh, double scale, const Pose& X_WO) {
  if (!(scale > 0) || !std::isfinite(scale)) {
    throw Error({.where = "scale",
                 .what = "not a factor a mesh can be placed with",
                 .found = fmt::format("{}", scale),
                 .expected = "a positive number"});
  }
  for (Vec3& vertex : mesh.vertices) vertex = X_WO * Vec3(scale * vertex);
  return mesh;
}

}  // namespace vicinity
