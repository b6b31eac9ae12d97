// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Finds points near a place: points sorted into cubes that fill their bounding box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "vicinity/geometry/vec3.h"

namespace vicinity {

class PointGrid {
 public:
  /// @param points  at least one
  /// @param reach   how far queries look, > 0 [m]
  PointGrid(const std::vector<Eigen::Vector3f>& points, float reach) : reach_(reach) {
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& point : points) box.extend(point);
    origin_ = box.min();
    // Cubes as small as the reach allows, and larger where they would outnumber the points by far.
    const auto most_cubes = 4. * static_cast<double>(points.size()) + 64;
    for (edge_ = reach;; edge_ *= 1.26f) {  // twice the volume
      const Eigen::Vector3d cubes = (box.sizes() / edge_).cast<double>().array().floor() + 1;
      if (cubes.prod() > most_cubes) continue;
      for (int axis = 0; axis < 3; ++axis) dims_[axis] = static_cast<int>(cubes[axis]);
      break;
    }
    std::vector<std::uint32_t> cube_of(points.size());
    first_.assign(static_cast<std::size_t>(dims_[0]) * dims_[1] * dims_[2] + 1, 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      cube_of[i] = static_cast<std::uint32_t>(index(cube(points[i])));
      ++first_[cube_of[i] + 1];
    }
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    entries_.resize(points.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      entries_[next[cube_of[i]]++] = {points[i], static_cast<std::uint32_t>(i)};
    }
  }

  /// Calls visit(index, squared_distance) for every point at most `reach` from p.
  template <class Visit>
  void visit_near(const Eigen::Vector3f& p, Visit&& visit) const {
    visit_block(cube(p), 1, [&](const Entry& entry) {
      const float squared = (entry.point - p).squaredNorm();
      if (squared <= reach_ * reach_) visit(entry.index, squared);
    });
  }

  /// The nearest point, at whatever distance; of equals, the first.
  std::uint32_t nearest(const Eigen::Vector3f& p) const {
    std::uint32_t best = 0;
    float best_squared = std::numeric_limits<float>::infinity();
    const int whole = std::max({dims_[0], dims_[1], dims_[2]});
    for (int blocks = 1;; blocks *= 2) {
      visit_block(cube(p), blocks, [&](const Entry& entry) {
        const float squared = (entry.point - p).squaredNorm();
        if (squared < best_squared || (squared == best_squared && entry.index < best)) {
          best = entry.index;
          best_squared = squared;
        }
      });
      // Whatever lies outside the block is at least this far away.
      const float seen = edge_ * static_cast<float>(blocks);
      if (best_squared <= seen * seen || blocks >= whole) return best;
    }
  }

 private:
  struct Entry {
    Eigen::Vector3f point;
    std::uint32_t index;
  };
  using Cube = std::array<int, 3>;

  Cube cube(const Eigen::Vector3f& p) const noexcept {
    Cube at{};
    for (int axis = 0; axis < 3; ++axis) {
      // Clamped first: a far place may be more cubes away than an int can count.
      const float cubes = (p[axis] - origin_[axis]) / edge_;
      at[axis] = static_cast<int>(std::clamp(cubes, 0.f, static_cast<float>(dims_[axis] - 1)));
    }
    return at;
  }

  std::size_t index(const Cube& c) const noexcept {
    return (static_cast<std::size_t>(c[0]) * dims_[1] + c[1]) * dims_[2] + c[2];
  }

  // All entries at most `reach` cubes away along each axis. Cubes along z follow one another.
  template <class Visit>
  void visit_block(const Cube& at, int reach, Visit&& visit) const {
    const auto low = [&](int axis) { return std::max(at[axis] - reach, 0); };
    const auto high = [&](int axis) { return std::min(at[axis] + reach, dims_[axis] - 1); };
    for (int x = low(0); x <= high(0); ++x) {
      for (int y = low(1); y <= high(1); ++y) {
        const std::uint32_t end = first_[index({x, y, high(2)}) + 1];
        for (std::uint32_t e = first_[index({x, y, low(2)})]; e < end; ++e) visit(entries_[e]);
      }
    }
  }

  float reach_, edge_ = 0;
  Eigen::Vector3f origin_;
  Cube dims_{};
  std::vector<std::uint32_t> first_;  // entry of each cube, and the end
  std::vector<Entry> entries_;
};

}  // namespace vicinity
