// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "picture/rank_palette.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vicinity::cli {
namespace {

// sRGB of a colour in OKLab's polar form (B. Ottosson, 2020).
Colour from_oklch(double lightness, double chroma, double hue_degrees) {
  const double hue = hue_degrees * std::numbers::pi / 180;
  const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  const auto encode = [](double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  };
  return {encode(+4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          encode(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          encode(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

}  // namespace

Colour rank_colour(int n, int q) {
  const double far = q > 1 ? static_cast<double>(n - 1) / (q - 1) : 0;
  // The hue takes the short way round through red and orange; chroma stays within sRGB.
  return from_oklch(0.45 + 0.50 * far, 0.17 - 0.09 * far * far, -15 + 120 * far);
}

Colour colour_of(const VoxelRecord& record, int q) {
  switch (record.kind) {
    case VoxelKind::neighbour:
      return rank_colour(record.rank, q);
    case VoxelKind::inner:
      return inner_colour;
    case VoxelKind::boundary:
      return boundary_colour;
    case VoxelKind::empty:
      break;
  }
  return white;
}

int most_ranks(const ViscosityField& field) {
  int q = 0;
  for (const FieldObject& object : field.objects()) q = std::max(q, object.q);
  return q;
}

}  // namespace vicinity::cli
