// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/layers/shaping_element.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

/// A set of cells around the origin with every symmetry of a cube, as runs along x: row (j,k)
/// holds -reach <= i <= reach, or nothing where reach is -1. Only 0 <= j, k <= radius is kept.
struct SymmetricRuns {
  explicit SymmetricRuns(int r)
      : radius(r), reach(static_cast<std::size_t>(r + 1) * static_cast<std::size_t>(r + 1), -1) {}

  int& at(int j, int k) { return reach[cell(j, k)]; }
  /// Reach of any row, -1 outside the radius.
  int of(int j, int k) const {
    j = std::abs(j);
    k = std::abs(k);
    return j > radius || k > radius ? -1 : reach[cell(j, k)];
  }

  int radius;
  std::vector<int> reach;

 private:
  std::size_t cell(int j, int k) const {
    return static_cast<std::size_t>(k) * static_cast<std::size_t>(radius + 1) +
           static_cast<std::size_t>(j);
  }
};

/// Minkowski sum with the element: along a row the longest of all sums of two runs.
SymmetricRuns sum(const SymmetricRuns& a, const ShapingElement& element) {
  SymmetricRuns result(a.radius + element.radius());
  for (int k = 0; k <= result.radius; ++k) {
    for (int j = 0; j <= k; ++j) {
      int longest = -1;
      for (const ShapingElement::Row& row : element.rows()) {
        const int reach = a.of(j - row.j, k - row.k);
        if (reach >= 0) longest = std::max(longest, reach + row.reach);
      }
      result.at(j, k) = result.at(k, j) = longest;
    }
  }
  return result;
}

/// Smallest gap between the closed cube of the origin and one of a cell outside the set. The first
/// cell outside of each row is its nearest one.
double smallest_gap_outside(const SymmetricRuns& cells) {
  const auto gap = [](int d) { return std::max(d - 1, 0); };
  int least = gap(cells.radius + 1) * gap(cells.radius + 1);
  for (int k = 0; k <= cells.radius; ++k) {
    for (int j = 0; j <= k; ++j) {
      const int i = cells.of(j, k) + 1;
      least = std::min(least, gap(i) * gap(i) + gap(j) * gap(j) + gap(k) * gap(k));
    }
  }
  return std::sqrt(least);
}

}  // namespace

const char* to_string(LayerShape shape) noexcept {
  switch (shape) {
    case LayerShape::cube:
      return "cube";
    case LayerShape::sphere:
      return "sphere";
    case LayerShape::distance:
      return "distance";
  }
  return "unknown";
}

ShapingElement::ShapingElement(LayerShape shape, int m) : shape_(shape), m_(m) {
  if (m < 1 || m > 8) {
    throw Error({.where = "m",
                 .what = "not a radius of the floating analyser zone",
                 .found = std::to_string(m),
                 .expected = "1 to 8 voxels"});
  }
  if (shape == LayerShape::distance) {
    throw Error({.where = "shape",
                 .what = "no mask",
                 .found = to_string(shape),
                 .expected = "\"cube\" or \"sphere\""});
  }
  for (int k = -m; k <= m; ++k) {
    for (int j = -m; j <= m; ++j) {
      int reach = m;
      while (reach >= 0 && !contains(reach, j, k)) --reach;
      if (reach >= 0) rows_.push_back({j, k, reach});
    }
  }
}

bool ShapingElement::contains(int i, int j, int k) const noexcept {
  if (std::abs(i) > m_ || std::abs(j) > m_ || std::abs(k) > m_) return false;
  return shape_ == LayerShape::cube || i * i + j * j + k * k <= m_ * m_;
}

int ShapingElement::cell_count() const noexcept {
  int count = 0;
  for (const Row& row : rows_) count += 2 * row.reach + 1;
  return count;
}

// A voxel of rank n cannot be reached from any boundary voxel by n - 1 steps of the element: its
// offset lies outside the (n-1)-fold Minkowski sum. A lone boundary voxel has neighbours at every
// offset outside, so that the bound is attained.
//
// True for any object whose inner voxels do not touch empty ones: let u be n - 1 steps from a
// boundary voxel. The steps can be chosen to have no opposed components, and walked voxel by voxel
// along the axes; from the last boundary voxel on this walk on, all voxels are empty (inner ones
// lie behind boundary ones), the rest of its step is still in the element, and so each stop on the
// way has at most the rank of its number.
std::vector<double> nearest_by_rank_vox(LayerShape shape, int m, int q) {
  if (q < 0 || q > 32) {
    throw Error({.where = "q",
                 .what = "not a number of ranks",
                 .found = std::to_string(q),
                 .expected = "0 to 32"});
  }
  std::vector<double> nearest;
  for (int n = 1; n <= q; ++n) nearest.push_back((n - 1) * m);
  if (shape == LayerShape::distance) return nearest;
  const ShapingElement element(shape, m);
  if (shape == LayerShape::cube) return nearest;  // n - 1 steps reach every offset nearer than that
  SymmetricRuns steps(0);
  steps.at(0, 0) = 0;
  for (std::size_t n = 1; n < nearest.size(); ++n) {
    steps = sum(steps, element);
    nearest[n] = std::min(nearest[n], smallest_gap_outside(steps));
  }
  return nearest;
}

double rank_bound_vox(LayerShape shape, int m, int q) {
  const std::vector<double> nearest = nearest_by_rank_vox(shape, m, q);
  double bound = 0;
  for (std::size_t n = 0; n < nearest.size(); ++n) {
    bound = std::max(bound, static_cast<double>(n) * m - nearest[n]);
  }
  return bound;
}

}  // namespace vicinity
