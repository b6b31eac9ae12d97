// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The features that can be nearest to any voxel of a box are those whose regions touch the box.
// Boxes are halved... 

#include "vicinity/layers/distance_layers.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "region_lanes.h"
#include "surface_features.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

/// A distance this little below a step, in steps, counts as that step, so that 2.5 voxels are
/// stored as 2.5 voxels however they were rounded. In voxels: 8e-9.
constexpr double forgiven_steps = 1e-6;

/// The box, grown to hold the voxels of all points in `bounds`.
VoxelBox hull(const VoxelBox& box, const Box& bounds) {
  if (bounds.isEmpty()) return box;
  const auto voxel = [](double centre) {
    return static_cast<std::int32_t>(std::floor(centre + 0.5));
  };
  const Vec3 &lo = bounds.min(), &hi = bounds.max();
  return {{std::min(box.lo.i, voxel(lo.x())), std::min(box.lo.j, voxel(lo.y())),
           std::min(box.lo.k, voxel(lo.z()))},
          {std::max(box.hi.i, voxel(hi.x()) + 1), std::max(box.hi.j, voxel(hi.y()) + 1),
           std::max(box.hi.k, voxel(hi.z()) + 1)}};
}

/// The middle of the voxel centres lo .. hi - 1 along one axis, and half their extent.
std::pair<float, float> middle_and_half(std::int32_t lo, std::int32_t hi) {
  return {0.5f * static_cast<float>(lo + hi - 1), 0.5f * static_cast<float>(hi - lo - 1)};
}

class SlabDistances {
 public:
  SlabDistances(const SurfaceFeatures& features, const VoxelSet& boundary, const VoxelSet& inner,
                int m, int q, DistanceLayers& layers)
      : features_(features), boundary_(boundary), inner_(inner), m_(m), q_(q), layers_(layers),
        box_(layers.distances.box()) {}

  void fill(std::int32_t slab, std::span<const std::uint32_t> listed) {
    slab_ = slab;
    const BlockIndex lo = layers_.distances.lo(), size = layers_.distances.size();
    const std::int32_t first_j = lo.j >> 3, last_j = (lo.j + size.j - 1) >> 3;
    const std::size_t tiles_j = static_cast<std::size_t>(last_j - first_j + 1);
    of_tile_.resize(tiles_j * static_cast<std::size_t>(size.i));
    for (auto& l : of_tile_) l.clear();
    regions_.resize(listed.size());
    ids_.assign(listed.begin(), listed.end());
    const auto [middle_z, half_z] = middle_and_half(slab * 8, slab * 8 + 8);
    for (std::uint32_t n = 0; n < listed.size(); ++n) {
      NearestRegion& region = regions_[n];
      features_.region_of(listed[n], region);
      const auto low = [&](int axis, std::int32_t least) {
        return std::max(static_cast<std::int32_t>(std::floor(region.lo[axis])), least);
      };
      const auto high = [&](int axis, std::int32_t most) {
        return std::min(static_cast<std::int32_t>(std::floor(region.hi[axis])), most);
      };
      const std::int32_t i_end = high(0, box_.hi.i - 1) >> 6, j_end = high(1, box_.hi.j - 1) >> 6;
      for (std::int32_t j = low(1, box_.lo.j) >> 6; j <= j_end; ++j) {
        for (std::int32_t i = low(0, box_.lo.i) >> 6; i <= i_end; ++i) {
          const auto [middle_x, half_x] = middle_and_half(i * 64, i * 64 + 64);
          const auto [middle_y, half_y] = middle_and_half(j * 64, j * 64 + 64);
          if (region.touches({middle_x, middle_y, middle_z}, {half_x, half_y, half_z})) {
            of_tile_[static_cast<std::size_t>(j - first_j) * static_cast<std::size_t>(size.i) +
                     static_cast<std::size_t>(i - lo.i)]
                .push_back(n);
          }
        }
      }
    }
    for (std::int32_t j = first_j; j <= last_j; ++j) {
      for (std::int32_t i = lo.i; i < lo.i + size.i; ++i) {
        const auto& tile =
            of_tile_[static_cast<std::size_t>(j - first_j) * static_cast<std::size_t>(size.i) +
                     static_cast<std::size_t>(i - lo.i)];
        if (!tile.empty()) fill_tile(i, j, tile);
      }
    }
  }

 private:
  void fill_tile(std::int32_t tile_i, std::int32_t tile_j, std::span<const std::uint32_t> listed) {
    EightBoxes blocks{.half_x = 31.5f, .half_y = 3.5f, .half_z = 3.5f};
    for (std::int32_t b = 0; b < 8; ++b) {
      blocks.x[b] = static_cast<float>(tile_i * 64) + 31.5f;
      blocks.y[b] = static_cast<float>(tile_j * 64 + b * 8) + 3.5f;
      blocks.z[b] = static_cast<float>(slab_ * 8) + 3.5f;
    }
    of_block_.fill(regions_, listed, blocks);
    for (std::int32_t b = 0; b < 8; ++b) {
      const auto list = of_block_[static_cast<std::size_t>(b)];
      if (!list.empty()) fill_block({tile_i, tile_j * 8 + b, slab_}, list);
    }
  }

  void fill_block(const BlockIndex& block, std::span<const std::uint32_t> listed) {
    if (!find_wanted(block)) return;
    block_ = block;
    steps_.fill(0);
    ranks_.fill(static_cast<std::uint8_t>(q_));
    EightBoxes bricks{.half_x = 3.5f, .half_y = 3.5f, .half_z = 3.5f};
    for (std::int32_t b = 0; b < 8; ++b) {
      bricks.x[b] = static_cast<float>(block.i * 64 + b * 8) + 3.5f;
      bricks.y[b] = static_cast<float>(block.j * 8) + 3.5f;
      bricks.z[b] = static_cast<float>(block.k * 8) + 3.5f;
    }
    of_brick_.fill(regions_, listed, bricks);
    for (std::int32_t b = 0; b < 8; ++b) {
      const auto list = of_brick_[static_cast<std::size_t>(b)];
      if (!list.empty() && ((any_wanted_[0] | any_wanted_[1] | any_wanted_[2] | any_wanted_[3]) >> (8 * b) & 0xff) != 0) fill_brick(b, list);
    }
    store();
  }

  void fill_brick(std::int32_t brick, std::span<const std::uint32_t> listed) {
    EightBoxes cells{.half_x = 1.5f, .half_y = 1.5f, .half_z = 1.5f};
    for (std::int32_t c = 0; c < 8; ++c) {
      cells.x[c] = static_cast<float>(block_.i * 64 + brick * 8 + (c & 1) * 4) + 1.5f;
      cells.y[c] = static_cast<float>(block_.j * 8 + (c >> 1 & 1) * 4) + 1.5f;
      cells.z[c] = static_cast<float>(block_.k * 8 + (c >> 2) * 4) + 1.5f;
    }
    of_cell_.fill(regions_, listed, cells);
    for (std::int32_t c = 0; c < 8; ++c) {
      const auto list = of_cell_[static_cast<std::size_t>(c)];
      const std::int32_t first_i = brick * 8 + (c & 1) * 4;
      if (list.empty() || (any_wanted_[static_cast<std::size_t>(c >> 1)] >> first_i & 0xf) == 0) continue;
      CellDistances distances;
      measure_cell(regions_, list, cells.x[c], cells.y[c], cells.z[c], distances);
      const float q_m = static_cast<float>(q_ * m_ + 1 + half_diagonal_vox);
      RoundedCell rounded;
      round_cell(distances, {128, static_cast<float>(half_diagonal_vox), 1 / static_cast<float>(m_), q_m}, rounded);
      const std::int32_t j0 = (c >> 1 & 1) * 4, k0 = (c >> 2) * 4;
      put(rounded, list, first_i, j0, k0);
    }
  }

  void put(RoundedCell& rounded, std::span<const std::uint32_t> listed, std::int32_t i0, std::int32_t j0, std::int32_t k0) {
    stat_cells++; stat_list += listed.size();
    for (std::int32_t k = 0; k < 4; ++k) {
      for (std::int32_t j = 0; j < 4; ++j) {
        const std::size_t row = static_cast<std::size_t>((k0 + k) * 8 + j0 + j);
        const std::uint64_t wanted = wanted_[row] >> i0 & 0xf;
        const std::size_t at = row * 64 + static_cast<std::size_t>(i0);
        const std::size_t from = static_cast<std::size_t>(k * 16 + j * 4);
        std::uint64_t unsure = (rounded.unsure >> from & 0xf) & wanted;
        for (; unsure != 0; unsure &= unsure - 1) {
          const int i = std::countr_zero(unsure);
          stat_unsure++;
          measure_exactly(listed, block_.i * 64 + i0 + i, block_.j * 8 + j0 + j, block_.k * 8 + k0 + k, rounded.steps[from + i], rounded.ranks[from + i]);
        }
        for (std::size_t i = 0; i < 4; ++i) {
          steps_[at + i] = rounded.steps[from + i];
          ranks_[at + i] = rounded.ranks[from + i];
        }
      }
    }
  }

  void measure_exactly(std::span<const std::uint32_t> listed, std::int32_t i, std::int32_t j, std::int32_t k, std::uint16_t& steps, std::uint8_t& rank) {
    const Vec3 p(i, j, k);
    double squared = std::numeric_limits<double>::infinity();
    for (const std::uint32_t n : listed) {
      if (regions_[n].holds(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k))) {
        squared = std::min(squared, features_.squared_distance(ids_[n], p));
      }
    }
    const double farthest = q_ * m_ + half_diagonal_vox;
    const double distance = std::sqrt(std::min(squared, farthest * farthest));
    const double s = std::max(0.0, distance - half_diagonal_vox);
    rank = static_cast<std::uint8_t>(squared < farthest * farthest ? std::min(static_cast<int>(s / m_), q_) : q_);
    steps = static_cast<std::uint16_t>(distance / distance_step_vox + forgiven_steps);
  }

  bool find_wanted(const BlockIndex& block) {
    std::uint64_t in_box = ~std::uint64_t{0};
    const std::int32_t i = block.i * 64;
    if (box_.lo.i > i) in_box &= ~std::uint64_t{0} << (box_.lo.i - i);
    if (box_.hi.i < i + 64) in_box &= ~std::uint64_t{0} >> (i + 64 - box_.hi.i);
    const BitBlock* inner = inner_.blocks().find(block);
    any_wanted_.fill(0);
    for (std::int32_t k = 0; k < 8; ++k) {
      for (std::int32_t j = 0; j < 8; ++j) {
        const std::int32_t row_j = block.j * 8 + j, row_k = block.k * 8 + k;
        const bool row_in_box = row_j >= box_.lo.j && row_j < box_.hi.j && row_k >= box_.lo.k && row_k < box_.hi.k;
        const std::size_t row = BitBlock::row(j, k);
        wanted_[row] = row_in_box ? in_box & ~(inner == nullptr ? 0 : inner->words[row]) : 0;
        any_wanted_[static_cast<std::size_t>((k >> 2) * 2 + (j >> 2))] |= wanted_[row];
      }
    }
    return (any_wanted_[0] | any_wanted_[1] | any_wanted_[2] | any_wanted_[3]) != 0;
  }

  void store() {
    const BitBlock* const boundary = boundary_.blocks().find(block_);
    std::array<BitBlock*, 32> ranks{};
    DistanceBlock* distances = nullptr;
    std::array<std::uint64_t, 64> of_rank;
    for (std::size_t row = 0; row < 64; ++row) {
      const std::uint64_t wanted = wanted_[row];
      if (wanted == 0) continue;
      const std::uint64_t skin = boundary == nullptr ? 0 : boundary->words[row];
      for (int n = 0; n <= q_ + 2; ++n) of_rank[static_cast<std::size_t>(n)] = 0;
      for (std::size_t i = 0; i < 64; ++i) of_rank[ranks_[row * 64 + i]] |= std::uint64_t{1} << i;
      std::uint64_t kept = wanted & skin;
      for (std::size_t n = 0; n < static_cast<std::size_t>(q_); ++n) {
        const std::uint64_t voxels = of_rank[n] & wanted & ~skin;
        if (voxels == 0) continue;
        if (ranks[n] == nullptr) ranks[n] = &layers_.neighbours.ranks[n].blocks().make(block_);
        ranks[n]->words[row] = voxels;
        kept |= voxels;
      }
      if (kept == 0) continue;
      if (distances == nullptr) distances = &layers_.distances.make(block_);
      for (std::size_t i = 0; i < 64; ++i) {
        distances->steps[row * 64 + i] = (kept >> i & 1) != 0 ? steps_[row * 64 + i] : std::uint16_t{0};
      }
    }
  }

  const SurfaceFeatures& features_;
  const VoxelSet &boundary_, &inner_;
  const int m_, q_;
  DistanceLayers& layers_;
  const VoxelBox box_;
  std::int32_t slab_ = 0;
  std::vector<std::vector<std::uint32_t>> of_tile_;
  std::vector<NearestRegion> regions_;
  std::vector<std::uint32_t> ids_;
  EightLists of_block_, of_brick_, of_cell_;
  BlockIndex block_;
  std::array<std::uint64_t, 64> wanted_;
  std::array<std::uint64_t, 4> any_wanted_;
  std::array<std::uint16_t, 4096> steps_;
  std::array<std::uint8_t, 4096> ranks_;
public:
  std::size_t stat_cells=0, stat_list=0, stat_unsure=0;
};

}  // namespace

DistanceLayers distance_layers(const TriangleMesh& mesh, const VoxelSet& boundary,
                               const VoxelSet& inner, const Workspace& workspace, int m, int q) {
  if (m < 1 || m > 8) {
    throw Error({.where = "m",
                 .what = "not a number of voxels per rank",
                 .found = std::to_string(m),
                 .expected = "1 to 8"});
  }
  if (q < 0 || q > 32) {
    throw Error({.where = "q",
                 .what = "not a number of ranks",
                 .found = std::to_string(q),
                 .expected = "0 to 32"});
  }
  const double reach = q * m + half_diagonal_vox + distance_step_vox;
  const SurfaceFeatures features(mesh, workspace, reach);

  // `probe` can leave parts of the surface a voxel outside of the boundary's box, and a centre
  // q*m + half_diagonal_vox away can lie a voxel beyond q*m voxels.
  VoxelBox box = boundary.box();
  if (!box.empty() && q > 0) box = hull(box, features.bounds()).grown(q * m + 1);
  DistanceLayers layers{{std::vector<VoxelSet>(static_cast<std::size_t>(q), VoxelSet(box))},
                        BlockGrid<DistanceBlock>(box)};
  if (box.empty()) return layers;

  const std::int32_t first_slab = layers.distances.lo().k;
  const std::int32_t slabs = layers.distances.size().k;
  constexpr std::size_t chunk = 4096;
  const std::size_t chunks = (features.size() + chunk - 1) / chunk;
  std::vector<std::vector<std::pair<std::int32_t, std::uint32_t>>> touched(chunks);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    NearestRegion region;
    for (std::size_t f = c * chunk; f < std::min(features.size(), (c + 1) * chunk); ++f) {
      if (!features.region_of(f, region)) continue;
      const auto low = std::max(static_cast<std::int32_t>(std::floor(region.lo[2])), box.lo.k) >> 3;
      const auto high = std::min(static_cast<std::int32_t>(std::floor(region.hi[2])), box.hi.k - 1) >> 3;
      for (std::int32_t k = low; k <= high; ++k) {
        const Eigen::Vector3f lo(region.lo), hi(region.hi);
        Eigen::Vector3f middle = 0.5f * (lo + hi), half = 0.5f * (hi - lo);
        std::tie(middle.z(), half.z()) = middle_and_half(k * 8, k * 8 + 8);
        if (region.touches(middle, half)) touched[c].push_back({k - first_slab, static_cast<std::uint32_t>(f)});
      }
    }
  });
  std::vector<std::vector<std::uint32_t>> of_slab(static_cast<std::size_t>(slabs));
  for (const auto& some : touched) {
    for (const auto& [k, f] : some) of_slab[static_cast<std::size_t>(k)].push_back(f);
  }

  tbb::enumerable_thread_specific<SlabDistances> of_thread(
      [&] { return SlabDistances(features, boundary, inner, m, q, layers); });
  tbb::parallel_for(0, slabs, [&](std::int32_t k) {
    of_thread.local().fill(first_slab + k, of_slab[static_cast<std::size_t>(k)]);
  });
  if (getenv("STAT")) for (auto& s : of_thread) fprintf(stderr, "cells %zu list %.1f unsure %.4f\n", s.stat_cells, double(s.stat_list)/double(s.stat_cells), double(s.stat_unsure)/64.0/double(s.stat_cells));
  return layers;
}

}  // namespace vicinity
