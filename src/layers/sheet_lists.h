// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Which features of a surface have to do with which sheet of voxels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry/whole_loops.h"
#include "nearest_region.h"
#include "surface_features.h"
#include "vicinity/voxel/huge_pages.h"

namespace vicinity {

/// For each sheet of voxels, the features whose regions touch it.
class SheetLists {
 public:
  explicit SheetLists(const SurfaceFeatures& features) {
    HugeVector<Range> ranges(features.size());
    whole::parallel_for(std::size_t{0}, ranges.size(),
                        [&](std::size_t f) { ranges[f] = range_of(features, f); });
    Range all;
    for (const Range& range : ranges) {
      all.first = std::min(all.first, range.first);
      all.last = std::max(all.last, range.last);
    }
    first_ = all.first;
    starts_.assign(static_cast<std::size_t>(std::max(all.last - all.first, -1) + 2), 0);
    const auto for_each = [&](const auto& visit) {
      for (std::size_t f = 0; f < ranges.size(); ++f) {
        for (std::int32_t sheet = ranges[f].first; sheet <= ranges[f].last; ++sheet) {
          visit(static_cast<std::size_t>(sheet - first_), static_cast<std::uint32_t>(f));
        }
      }
    };
    for_each([&](std::size_t sheet, std::uint32_t) { ++starts_[sheet + 1]; });
    for (std::size_t n = 1; n < starts_.size(); ++n) starts_[n] += starts_[n - 1];
    features_.resize(starts_.back());
    std::vector<std::size_t> fill(starts_);
    for_each([&](std::size_t sheet, std::uint32_t f) { features_[fill[sheet]++] = f; });
  }

  std::span<const std::uint32_t> operator[](std::int32_t sheet) const {
    const std::int64_t n = std::int64_t{sheet} - first_;
    if (n < 0 || n + 1 >= static_cast<std::int64_t>(starts_.size())) return {};
    const std::size_t start = starts_[static_cast<std::size_t>(n)];
    return {features_.data() + start, starts_[static_cast<std::size_t>(n + 1)] - start};
  }

 private:
  /// From the first to the last sheet touched; a region is convex, and touches all between.
  struct Range {
    std::int32_t first = std::numeric_limits<std::int32_t>::max() / 2;
    std::int32_t last = std::numeric_limits<std::int32_t>::min() / 2;
  };

  static Range range_of(const SurfaceFeatures& features, std::size_t feature) {
    Range range;
    NearestRegion region;
    Eigen::AlignedBox3f bounds;
    if (!features.region_of(feature, region, bounds)) return range;
    Eigen::Vector3f middle = bounds.center(), half = 0.5f * bounds.sizes();
    half.z() = 0.5f * static_cast<float>(sheet_size - 1);
    const auto sheet_of = [](float z) {
      return static_cast<std::int32_t>(std::floor(z)) >> sheet_shift;
    };
    const std::int32_t end = sheet_of(bounds.max().z()) + 1;
    for (std::int32_t sheet = sheet_of(bounds.min().z()); sheet < end; ++sheet) {
      middle.z() = static_cast<float>(sheet * sheet_size) + half.z();
      if (!region.touches(middle, half)) continue;
      range.first = std::min(range.first, sheet);
      range.last = sheet;
    }
    return range;
  }

  std::int32_t first_;
  std::vector<std::size_t> starts_;  ///< of each sheet's part of features_, and the end
  HugeVector<std::uint32_t> features_;
};

}  // namespace vicinity
