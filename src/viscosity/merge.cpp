// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "merge.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "vicinity/viscosity/field_image.h"

namespace vicinity {
namespace {

constexpr std::size_t block_voxels = 64 * 8 * 8;

/// The bits of a block that lie in the workspace, row by row.
std::array<std::uint64_t, 64> rows_within(const VoxelIndex& dims, const BlockIndex& b) {
  const std::int32_t along_x = std::min(dims.i - b.i * 64, 64);
  const std::uint64_t row = ~std::uint64_t{0} >> (64 - along_x);
  std::array<std::uint64_t, 64> rows{};
  for (std::int32_t k = 0; k < std::min(dims.k - b.k * 8, 8); ++k) {
    for (std::int32_t j = 0; j < std::min(dims.j - b.j * 8, 8); ++j)
      rows[BitBlock::row(j, k)] = row;
  }
  return rows;
}

/// Calls visit(first, length) for every run of ones, lowest first.
template <class Visit>
void for_each_run(std::uint64_t word, Visit&& visit) {
  while (word != 0) {
    const int first = std::countr_zero(word);
    const int length = std::countr_one(word >> first);
    visit(static_cast<std::size_t>(first), static_cast<std::size_t>(length));
    word = first + length == 64 ? 0 : word & (~std::uint64_t{0} << (first + length));
  }
}

/// One kind of one object's voxels in the block at hand.
struct Stratum {
  VoxelCode code;
  const BitBlock* bits;
};

/// The voxels of one block of the workspace, 64 x 8 x 8: a row of eight bricks.
class MergedBlock {
 public:
  MergedBlock(const std::vector<FieldObject>& objects, const std::vector<VoxelRecord>& records)
      : objects_(objects), records_(records) {}

  void clear() {
    codes_.fill(0);
    steps_.fill(no_distance);
  }

  /// Lays voxels into free space; the fast way for a block that only one object touches.
  void lay(const Stratum& stratum, const DistanceBlock* distances,
           const std::array<std::uint64_t, 64>& within) {
    for (std::size_t row = 0; row < 64; ++row) {
      for_each_run(stratum.bits->words[row] & within[row],
                   [&](std::size_t first, std::size_t length) {
                     const std::size_t at = row * 64 + first;
                     std::fill_n(codes_.begin() + at, length, stratum.code);
                     if (distances != nullptr) {
                       std::copy_n(distances->steps.begin() + at, length, steps_.begin() + at);
                     }
                   });
    }
  }

  /// Lays voxels over what is there, each where it wins.
  void contest(const Stratum& stratum, const DistanceBlock* distances,
               const std::array<std::uint64_t, 64>& within) {
    const VoxelRecord& record = records_[stratum.code];
    const FieldObject& object = objects_[record.object];
    const bool by_distance = distances != nullptr && record.kind == VoxelKind::neighbour;
    double viscosity = record.kind == VoxelKind::neighbour ? object.coding.of_rank(record.rank)
                                                           : object.coding.skin;
    for (std::size_t row = 0; row < 64; ++row) {
      for (std::uint64_t bits = stratum.bits->words[row] & within[row]; bits != 0;
           bits &= bits - 1) {
        const std::size_t at = row * 64 + static_cast<std::size_t>(std::countr_zero(bits));
        if (by_distance) {
          viscosity = object.coding.at_distance(
              distances->steps[at] * distance_step_vox - half_diagonal_vox, object.m, object.q);
        }
        const VoxelKind rival = records_[codes_[at]].kind;
        if (codes_[at] != 0 &&
            (rival > record.kind || (rival == record.kind && viscosities_[at] >= viscosity))) {
          continue;
        }
        codes_[at] = stratum.code;
        viscosities_[at] = viscosity;
        steps_[at] = distances == nullptr ? no_distance : distances->steps[at];
      }
    }
  }

  void count(VoxelCounts& counts) const {
    std::array<std::uint64_t, 4> of_kind{};
    for (const VoxelCode code : codes_) ++of_kind[static_cast<std::size_t>(records_[code].kind)];
    counts.neighbour += of_kind[static_cast<std::size_t>(VoxelKind::neighbour)];
    counts.inner += of_kind[static_cast<std::size_t>(VoxelKind::inner)];
    counts.boundary += of_kind[static_cast<std::size_t>(VoxelKind::boundary)];
  }

  /// Cuts the block into its bricks.
  void put_into(RegionDraft& region, std::size_t first_brick, bool keeps_distance) const {
    std::array<std::uint16_t, 512> brick;
    for (std::size_t b = 0; b < 8; ++b) {
      cut(codes_, b, brick);
      region.put_codes(first_brick + b, brick);
      if (!keeps_distance) continue;
      cut(steps_, b, brick);
      region.put_distances(first_brick + b, brick);
    }
  }

 private:
  static void cut(const std::array<std::uint16_t, block_voxels>& block, std::size_t b,
                  std::array<std::uint16_t, 512>& brick) {
    for (std::size_t row = 0; row < 64; ++row) {
      std::copy_n(block.begin() + row * 64 + b * 8, 8, brick.begin() + row * 8);
    }
  }

  const std::vector<FieldObject>& objects_;
  const std::vector<VoxelRecord>& records_;
  std::array<VoxelCode, block_voxels> codes_;
  std::array<std::uint16_t, block_voxels> steps_;
  std::array<double, block_voxels> viscosities_;  // of contested voxels only
};

bool touches(const VoxelSet& voxels, const VoxelBox& box) {
  const VoxelBox& b = voxels.box();
  return !b.empty() && b.lo.i < box.hi.i && box.lo.i < b.hi.i && b.lo.j < box.hi.j &&
         box.lo.j < b.hi.j && b.lo.k < box.hi.k && box.lo.k < b.hi.k;
}

/// What every region is made from.
class Merge {
 public:
  struct Region {
    RegionDraft draft;
    VoxelCounts counts;
  };

  Merge(const Workspace& workspace, const std::vector<FieldObject>& objects,
        const std::vector<ObjectVoxelArray>& arrays)
      : workspace_(workspace), objects_(objects), arrays_(arrays), records_(records_of(objects)) {
    for (std::size_t o = 0, code = 1; o < objects.size(); ++o) {
      first_codes_.push_back(static_cast<VoxelCode>(code));
      code += 2 + static_cast<std::size_t>(objects[o].q);
      keeps_distance_ |= objects[o].layers == LayerShape::distance;
    }
  }

  Region region_at(const VoxelIndex& region) const {
    const VoxelIndex lo = {region.i * 64, region.j * 64, region.k * 64};
    const VoxelBox box = {lo, {lo.i + 64, lo.j + 64, lo.k + 64}};
    std::vector<std::size_t> near;
    for (std::size_t o = 0; o < arrays_.size(); ++o) {
      const ObjectVoxelArray& array = arrays_[o];
      const auto& ranks = array.layers.neighbours.ranks;
      if (touches(array.boundary, box) || touches(array.inner, box) ||
          std::any_of(ranks.begin(), ranks.end(),
                      [&](const VoxelSet& rank) { return touches(rank, box); })) {
        near.push_back(o);
      }
    }

    Region made;
    if (near.empty()) return made;
    const auto block = std::make_unique<MergedBlock>(objects_, records_);
    for (std::int32_t k = 0; k < 8; ++k) {
      for (std::int32_t j = 0; j < 8; ++j) {
        const BlockIndex at = {region.i, region.j * 8 + j, region.k * 8 + k};
        if (at.j * 8 >= workspace_.dims.j || at.k * 8 >= workspace_.dims.k) continue;
        if (!merge_block(near, at, *block)) continue;
        block->count(made.counts);
        block->put_into(made.draft, static_cast<std::size_t>(k * 64 + j * 8), keeps_distance_);
      }
    }
    return made;
  }

 private:
  /// Whether any object has a voxel there.
  bool merge_block(const std::vector<std::size_t>& near, const BlockIndex& at,
                   MergedBlock& block) const {
    std::vector<Stratum> strata;
    for (const std::size_t o : near) gather(o, at, strata);
    if (strata.empty()) return false;

    block.clear();
    const auto within = rows_within(workspace_.dims, at);
    const auto object_of = [&](const Stratum& s) { return records_[s.code].object; };
    const bool contested = object_of(strata.front()) != object_of(strata.back());
    for (const Stratum& stratum : strata) {
      const DistanceBlock* distances = records_[stratum.code].kind == VoxelKind::inner
                                           ? nullptr
                                           : arrays_[object_of(stratum)].layers.distances.find(at);
      if (contested) {
        block.contest(stratum, distances, within);
      } else {
        block.lay(stratum, distances, within);
      }
    }
    return true;
  }

  void gather(std::size_t o, const BlockIndex& at, std::vector<Stratum>& strata) const {
    const auto add = [&](const VoxelSet& voxels, std::size_t nth) {
      const BitBlock* bits = voxels.blocks().find(at);
      if (bits != nullptr) {
        strata.push_back({static_cast<VoxelCode>(first_codes_[o] + nth), bits});
      }
    };
    const ObjectVoxelArray& array = arrays_[o];
    add(array.boundary, 0);
    add(array.inner, 1);
    const auto& ranks = array.layers.neighbours.ranks;
    for (std::size_t n = 0; n < ranks.size(); ++n) add(ranks[n], n + 2);
  }

  const Workspace& workspace_;
  const std::vector<FieldObject>& objects_;
  const std::vector<ObjectVoxelArray>& arrays_;
  std::vector<VoxelRecord> records_;
  std::vector<VoxelCode> first_codes_;
  bool keeps_distance_ = false;
};

}  // namespace

ViscosityField merge(const Workspace& workspace, const std::vector<FieldObject>& objects,
                     std::vector<ObjectVoxelArray> arrays,
                     const std::function<void(double done)>& progress) {
  const Merge merge(workspace, objects, arrays);
  FieldWriter writer(workspace, objects);
  VoxelCounts counts;

  // Regions are made by any thread and put in one by one, in order: the image is then the same for
  // any number of threads. Tokens bound how many drafts wait.
  const VoxelIndex dims = writer.region_dims();
  const std::int64_t last = std::int64_t{dims.i} * dims.j * dims.k;
  const auto tokens = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) * 4;
  std::int64_t next = 0;
  std::int64_t done = 0;
  tbb::parallel_pipeline(
      tokens,
      tbb::make_filter<void, VoxelIndex>(tbb::filter_mode::serial_in_order,
                                         [&](tbb::flow_control& flow) -> VoxelIndex {
                                           if (next == last) {
                                             flow.stop();
                                             return {};
                                           }
                                           const std::int64_t r = next++;
                                           return {static_cast<std::int32_t>(r % dims.i),
                                                   static_cast<std::int32_t>(r / dims.i % dims.j),
                                                   static_cast<std::int32_t>(r / dims.i / dims.j)};
                                         }) &
          tbb::make_filter<VoxelIndex, Merge::Region>(
              tbb::filter_mode::parallel,
              [&](const VoxelIndex& region) { return merge.region_at(region); }) &
          tbb::make_filter<Merge::Region, void>(
              tbb::filter_mode::serial_in_order, [&](const Merge::Region& region) {
                writer.append(region.draft);
                counts.boundary += region.counts.boundary;
                counts.inner += region.counts.inner;
                counts.neighbour += region.counts.neighbour;
                ++done;
                progress(static_cast<double>(done) / static_cast<double>(last));
              }));
  arrays.clear();
  return writer.finish(counts);
}

}  // namespace vicinity
