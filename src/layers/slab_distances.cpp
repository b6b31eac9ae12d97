// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "slab_distances.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace vicinity {
namespace {

/// A distance this little below a step, in steps, counts as that step, so that 2.5 voxels are
/// stored as 2.5 voxels however they were rounded. In voxels: 8e-9.
constexpr double forgiven_steps = 1e-6;

/// The middle of the `size` voxel centres from `first`.
float middle_of(std::int32_t first, std::int32_t size) {
  return static_cast<float>(first) + 0.5f * static_cast<float>(size - 1);
}

/// Eight boxes of one size; first(n) is the first voxel of the nth.
template <class First>
EightBoxes eight_boxes(const VoxelIndex& size, First&& first) {
  EightBoxes boxes;
  boxes.half_x = middle_of(0, size.i);
  boxes.half_y = middle_of(0, size.j);
  boxes.half_z = middle_of(0, size.k);
  for (std::int32_t n = 0; n < 8; ++n) {
    const VoxelIndex lo = first(n);
    boxes.x[n] = middle_of(lo.i, size.i);
    boxes.y[n] = middle_of(lo.j, size.j);
    boxes.z[n] = middle_of(lo.k, size.k);
  }
  return boxes;
}

/// Bit `bit` of 64 bytes, the first byte's lowest.
std::uint64_t bits_of(const std::uint8_t* bytes, std::size_t bit) {
  std::uint64_t bits = 0;
  for (std::size_t first = 0; first < 64; first += 8) {
    std::uint64_t eight = 0;
    for (std::size_t b = 0; b < 8; ++b) eight |= std::uint64_t{bytes[first + b]} << (8 * b);
    // A bit from each byte, gathered in the highest byte.
    bits |= (((eight >> bit & 0x0101010101010101u) * 0x0102040810204080u) >> 56) << first;
  }
  return bits;
}

/// Copies the steps of a row's voxels that are kept; the others become 0.
void copy_kept(const std::uint16_t* steps, std::uint64_t kept, std::uint16_t* to) {
  for (std::size_t first = 0; first < 64; first += 16) {
    const auto some = static_cast<std::uint16_t>(kept >> first);
    for (std::size_t i = 0; i < 16; ++i) {
      const auto bit = static_cast<std::uint16_t>(1u << i);
      to[first + i] = (some & bit) == bit ? steps[first + i] : std::uint16_t{0};
    }
  }
}

}  // namespace

SlabDistances::SlabDistances(const SurfaceFeatures& features, const VoxelSet& boundary,
                             const VoxelSet& inner, int m, int q, DistanceLayers& layers)
    : features_(features),
      boundary_(boundary),
      inner_(inner),
      m_(m),
      q_(q),
      layers_(layers),
      box_(layers.distances.box()),
      rounding_{.steps_per_voxel = static_cast<float>(1 / distance_step_vox),
                .zero = static_cast<float>(half_diagonal_vox),
                .ranks_per_voxel = 1 / static_cast<float>(m),
                .farthest = static_cast<float>(q * m + half_diagonal_vox + 1),
                .no_rank = q,
                .most_steps =
                    static_cast<std::int32_t>((q * m + half_diagonal_vox) / distance_step_vox)} {
  const BlockIndex lo = layers.distances.lo(), size = layers.distances.size();
  first_tile_j_ = lo.j >> 3;
  tiles_j_ = ((lo.j + size.j - 1) >> 3) - first_tile_j_ + 1;
  of_tile_.resize(static_cast<std::size_t>(size.i) * static_cast<std::size_t>(tiles_j_));
}

void SlabDistances::fill(std::int32_t slab, std::span<const std::uint32_t> listed) {
  slab_ = slab;
  ids_ = listed;
  sort_into_tiles(listed);
  const BlockIndex lo = layers_.distances.lo(), size = layers_.distances.size();
  for (std::size_t tile = 0; tile < of_tile_.size(); ++tile) {
    if (of_tile_[tile].empty()) continue;
    const auto n = static_cast<std::int32_t>(tile);
    fill_tile(lo.i + n % size.i, first_tile_j_ + n / size.i, of_tile_[tile]);
  }
}

void SlabDistances::sort_into_tiles(std::span<const std::uint32_t> listed) {
  for (auto& tile : of_tile_) tile.clear();
  regions_.resize(listed.size());
  const BlockIndex lo = layers_.distances.lo(), size = layers_.distances.size();
  const auto tile_of = [](float p, std::int32_t least, std::int32_t most) {
    return std::clamp(static_cast<std::int32_t>(std::floor(p)), least, most) >> 6;
  };
  for (std::uint32_t n = 0; n < listed.size(); ++n) {
    NearestRegion& region = regions_[n];
    if (!features_.region_of(listed[n], region)) continue;
    if (region.hi.x() < static_cast<float>(box_.lo.i) ||
        region.lo.x() > static_cast<float>(box_.hi.i - 1) ||
        region.hi.y() < static_cast<float>(box_.lo.j) ||
        region.lo.y() > static_cast<float>(box_.hi.j - 1)) {
      continue;
    }
    const std::int32_t last_i = tile_of(region.hi.x(), box_.lo.i, box_.hi.i - 1);
    const std::int32_t last_j = tile_of(region.hi.y(), box_.lo.j, box_.hi.j - 1);
    for (std::int32_t j = tile_of(region.lo.y(), box_.lo.j, box_.hi.j - 1); j <= last_j; ++j) {
      for (std::int32_t i = tile_of(region.lo.x(), box_.lo.i, box_.hi.i - 1); i <= last_i; ++i) {
        if (!region.touches({middle_of(i * 64, 64), middle_of(j * 64, 64), middle_of(slab_ * 8, 8)},
                            {middle_of(0, 64), middle_of(0, 64), middle_of(0, 8)})) {
          continue;
        }
        of_tile_[static_cast<std::size_t>((j - first_tile_j_) * size.i + (i - lo.i))].push_back(n);
      }
    }
  }
}

void SlabDistances::fill_tile(std::int32_t tile_i, std::int32_t tile_j,
                              std::span<const std::uint32_t> listed) {
  of_block_.fill(regions_, listed, eight_boxes({64, 8, 8}, [&](std::int32_t n) {
                   return VoxelIndex{tile_i * 64, tile_j * 64 + n * 8, slab_ * 8};
                 }));
  for (std::int32_t n = 0; n < 8; ++n) {
    block_ = {tile_i, tile_j * 8 + n, slab_};
    const auto touching = of_block_[static_cast<std::size_t>(n)];
    if (!touching.empty() && find_wanted()) fill_block(touching);
  }
}

/// Finds which voxels of the block are asked for. Returns false where none is.
bool SlabDistances::find_wanted() {
  std::uint64_t in_box = ~std::uint64_t{0};
  const std::int32_t i = block_.i * 64;
  if (box_.lo.i > i) in_box &= ~std::uint64_t{0} << (box_.lo.i - i);
  if (box_.hi.i < i + 64) in_box &= ~std::uint64_t{0} >> (i + 64 - box_.hi.i);
  const BitBlock* const inner = inner_.blocks().find(block_);
  any_wanted_.fill(0);
  for (std::int32_t k = 0; k < 8; ++k) {
    for (std::int32_t j = 0; j < 8; ++j) {
      const std::int32_t row_j = block_.j * 8 + j, row_k = block_.k * 8 + k;
      const bool row_in_box =
          row_j >= box_.lo.j && row_j < box_.hi.j && row_k >= box_.lo.k && row_k < box_.hi.k;
      const std::size_t row = BitBlock::row(j, k);
      wanted_[row] = row_in_box ? in_box & ~(inner == nullptr ? 0 : inner->words[row]) : 0;
      any_wanted_[static_cast<std::size_t>((k >> 2) * 2 + (j >> 2))] |= wanted_[row];
    }
  }
  return (any_wanted_[0] | any_wanted_[1] | any_wanted_[2] | any_wanted_[3]) != 0;
}

void SlabDistances::fill_block(std::span<const std::uint32_t> listed) {
  ranks_.fill(static_cast<std::uint8_t>(q_));
  steps_.fill(0);
  of_brick_.fill(regions_, listed, eight_boxes({8, 8, 8}, [&](std::int32_t n) {
                   return VoxelIndex{block_.i * 64 + n * 8, block_.j * 8, block_.k * 8};
                 }));
  for (std::int32_t n = 0; n < 8; ++n) {
    const auto touching = of_brick_[static_cast<std::size_t>(n)];
    const std::uint64_t wanted = any_wanted_[0] | any_wanted_[1] | any_wanted_[2] | any_wanted_[3];
    if (!touching.empty() && (wanted >> (n * 8) & 0xff) != 0) fill_brick(n * 8, touching);
  }
  store();
}

void SlabDistances::fill_brick(std::int32_t first_i, std::span<const std::uint32_t> listed) {
  const auto first_of = [&](std::int32_t n) {  // within the block
    return VoxelIndex{first_i + (n & 1) * 4, (n >> 1 & 1) * 4, (n >> 2) * 4};
  };
  of_cell_.fill(
      regions_, listed, eight_boxes({4, 4, 4}, [&](std::int32_t n) {
        const VoxelIndex first = first_of(n);
        return VoxelIndex{block_.i * 64 + first.i, block_.j * 8 + first.j, block_.k * 8 + first.k};
      }));
  for (std::int32_t n = 0; n < 8; ++n) {
    const auto touching = of_cell_[static_cast<std::size_t>(n)];
    const VoxelIndex first = first_of(n);
    const bool wanted = (any_wanted_[static_cast<std::size_t>(n >> 1)] >> first.i & 0xf) != 0;
    if (wanted && !touching.empty()) fill_cell(first, touching);
  }
}

void SlabDistances::fill_cell(const VoxelIndex& first, std::span<const std::uint32_t> listed) {
  const VoxelIndex lo{block_.i * 64 + first.i, block_.j * 8 + first.j, block_.k * 8 + first.k};
  CellDistances distances;
  measure_cell(regions_, listed, middle_of(lo.i, 4), middle_of(lo.j, 4), middle_of(lo.k, 4),
               distances);
  RoundedCell rounded;
  round_cell(distances, rounding_, rounded);
  for (std::int32_t k = 0; k < 4; ++k) {
    for (std::int32_t j = 0; j < 4; ++j) {
      const std::size_t row = BitBlock::row(first.j + j, first.k + k);
      const auto in_cell = static_cast<std::size_t>(k * 16 + j * 4);
      std::uint64_t unsure = (rounded.unsure >> in_cell) & (wanted_[row] >> first.i) & 0xf;
      for (; unsure != 0; unsure &= unsure - 1) {
        const int i = std::countr_zero(unsure);
        const std::size_t v = in_cell + static_cast<std::size_t>(i);
        measure_again({lo.i + i, lo.j + j, lo.k + k}, listed, rounded.steps[v], rounded.ranks[v]);
      }
      const std::size_t in_block = row * 64 + static_cast<std::size_t>(first.i);
      std::copy_n(rounded.steps + in_cell, 4, steps_.begin() + in_block);
      std::copy_n(rounded.ranks + in_cell, 4, ranks_.begin() + in_block);
    }
  }
}

void SlabDistances::measure_again(const VoxelIndex& voxel, std::span<const std::uint32_t> listed,
                                  std::uint16_t& steps, std::uint8_t& rank) const {
  const Vec3 p(voxel.i, voxel.j, voxel.k);
  const Eigen::Vector3f near_p = p.cast<float>();
  double squared = std::numeric_limits<double>::infinity();
  for (const std::uint32_t n : listed) {
    if (regions_[n].holds(near_p)) {
      squared = std::min(squared, features_.squared_distance(ids_[n], p));
    }
  }
  const double farthest = q_ * m_ + half_diagonal_vox;
  const double distance = std::sqrt(std::min(squared, farthest * farthest));
  steps = static_cast<std::uint16_t>(distance / distance_step_vox + forgiven_steps);
  const double s = std::max(0.0, distance - half_diagonal_vox);
  rank = static_cast<std::uint8_t>(
      squared < farthest * farthest ? std::min(static_cast<int>(s / m_), q_) : q_);
}

/// Puts the block's ranks and distances into the layers.
void SlabDistances::store() {
  const BitBlock* const boundary = boundary_.blocks().find(block_);
  const auto bits = static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(q_)));
  std::array<std::uint64_t, 6> bit_of_rank{};
  std::array<BitBlock*, 32> ranks{};
  DistanceBlock* distances = nullptr;
  for (std::size_t row = 0; row < 64; ++row) {
    const std::uint64_t skin = wanted_[row] & (boundary == nullptr ? 0 : boundary->words[row]);
    const std::uint64_t free = wanted_[row] & ~skin;
    for (std::size_t b = 0; b < bits; ++b) bit_of_rank[b] = bits_of(&ranks_[row * 64], b);
    std::uint64_t kept = skin;
    for (std::size_t n = 0; n < static_cast<std::size_t>(q_); ++n) {
      std::uint64_t voxels = free;
      for (std::size_t b = 0; b < bits; ++b) {
        voxels &= (n >> b & 1) != 0 ? bit_of_rank[b] : ~bit_of_rank[b];
      }
      if (voxels == 0) continue;
      if (ranks[n] == nullptr) ranks[n] = &layers_.neighbours.ranks[n].blocks().make(block_);
      ranks[n]->words[row] = voxels;
      kept |= voxels;
    }
    if (kept == 0) continue;
    if (distances == nullptr) distances = &layers_.distances.make(block_);
    copy_kept(&steps_[row * 64], kept, &distances->steps[row * 64]);
  }
}

}  // namespace vicinity
