// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "object_voxel_array.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <utility>

#include "vicinity/layers/distance_layers.h"
#include "vicinity/layers/layer_bricks.h"
#include "vicinity/voxel/voxeliser.h"

namespace vicinity {
namespace {

// Tiles are cubes of four regions: large beside their halo, small beside the caches.
constexpr std::int32_t tile_regions = 4;
constexpr std::int32_t tile_side = tile_regions * 64;

VoxelIndex region_of(const VoxelIndex& v) { return {v.i >> 6, v.j >> 6, v.k >> 6}; }

/// Regions on their way into an array.
struct Drafts {
  struct Region {
    VoxelIndex at;
    RegionDraft draft;
    std::vector<std::uint64_t> counts;
  };
  std::vector<std::unique_ptr<Region>> regions;

  Region& add(const VoxelIndex& at, int q) {
    return *regions.emplace_back(std::make_unique<Region>(
        Region{at, {}, std::vector<std::uint64_t>(object_code::count(q))}));
  }
};

/// Adds the time from its making to its end.
class Stopwatch {
 public:
  explicit Stopwatch(std::atomic<std::int64_t>& sum) : sum_(sum) {}
  ~Stopwatch() {
    sum_ += std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::atomic<std::int64_t>& sum_;
  Clock::time_point start_ = Clock::now();
};

/// Makes pieces of an array by any thread and puts them in by one, in order.
template <class Make>
void put_in_order(std::size_t count, ObjectVoxelArray& array,
                  const std::function<void(double)>& onward, const Make& make) {
  // Tokens bound how many drafts wait.
  const auto tokens = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) * 2;
  std::size_t next = 0, done = 0;
  tbb::parallel_pipeline(
      tokens, tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                                  [&](tbb::flow_control& flow) {
                                                    if (next == count) flow.stop();
                                                    return next++;
                                                  }) &
                  tbb::make_filter<std::size_t, std::shared_ptr<Drafts>>(
                      tbb::filter_mode::parallel,
                      [&](std::size_t n) { return std::make_shared<Drafts>(make(n)); }) &
                  tbb::make_filter<std::shared_ptr<Drafts>, void>(
                      tbb::filter_mode::serial_in_order, [&](const std::shared_ptr<Drafts>& made) {
                        for (const auto& region : made->regions)
                          array.put(region->at, region->draft, region->counts);
                        onward(static_cast<double>(++done) / static_cast<double>(count));
                      }));
}

/// Gives the bricks of a tile to its regions.
void draft(const LayerBricks& bricks, int q, Drafts& drafts) {
  std::array<Drafts::Region*, tile_regions * tile_regions * tile_regions> made{};
  bricks.for_each_brick([&](const BlockIndex& b, std::span<const BrickBits> planes) {
    const VoxelIndex at = {b.i >> 3, b.j >> 3, b.k >> 3};
    Drafts::Region*& region = made[static_cast<std::size_t>(
        ((at.k & 3) * tile_regions + (at.j & 3)) * tile_regions + (at.i & 3))];
    if (region == nullptr) region = &drafts.add(at, q);
    region->draft.put_planes(static_cast<std::size_t>(((b.k & 7) * 8 + (b.j & 7)) * 8 + (b.i & 7)),
                             planes, region->counts);
  });
}

/// A tile that is inner throughout.
void draft_inner(const VoxelBox& tile, int q, Drafts& drafts) {
  for (std::int32_t k = tile.lo.k >> 6; k < tile.hi.k >> 6; ++k) {
    for (std::int32_t j = tile.lo.j >> 6; j < tile.hi.j >> 6; ++j) {
      for (std::int32_t i = tile.lo.i >> 6; i < tile.hi.i >> 6; ++i) {
        Drafts::Region& region = drafts.add({i, j, k}, q);
        for (std::size_t b = 0; b < 512; ++b) region.draft.put_uniform(b, object_code::inner);
        region.counts[object_code::inner] = 64 * 64 * 64;
      }
    }
  }
}

/// Ranked by a shaping element.
ObjectVoxelArray ranked_array(const SceneObject& object, const Voxeliser& voxeliser,
                              StageTimes& times, const std::function<void(double)>& onward) {
  const ShapingElement element(object.layers, object.m);
  const VoxelBox box = voxeliser.box().grown(object.q * object.m);
  ObjectVoxelArray array(box, object.q, false);

  const auto tiles = [](std::int32_t lo, std::int32_t hi) {
    const std::int32_t first = lo & ~(tile_side - 1);
    return std::pair{first, (hi - first + tile_side - 1) / tile_side};
  };
  const auto [i_first, i_count] = tiles(box.lo.i, box.hi.i);
  const auto [j_first, j_count] = tiles(box.lo.j, box.hi.j);
  const auto [k_first, k_count] = tiles(box.lo.k, box.hi.k);
  const auto tile_at = [&](std::size_t n) {
    const auto at = static_cast<std::int64_t>(n);
    const VoxelIndex lo = {i_first + static_cast<std::int32_t>(at % i_count) * tile_side,
                           j_first + static_cast<std::int32_t>(at / i_count % j_count) * tile_side,
                           k_first + static_cast<std::int32_t>(at / i_count / j_count) * tile_side};
    return VoxelBox{lo, {lo.i + tile_side, lo.j + tile_side, lo.k + tile_side}};
  };

  tbb::enumerable_thread_specific<LayerBricks> memory;
  put_in_order(static_cast<std::size_t>(std::int64_t{i_count} * j_count * k_count), array, onward,
               [&](std::size_t n) {
                 Drafts drafts;
                 const VoxelBox tile = tile_at(n);
                 const VoxelBox seen = tile.grown(LayerBricks::halo(object.m, object.q));
                 VoxelSet boundary, inner;
                 {
                   const Stopwatch watch(times.voxelise);
                   boundary = voxeliser.boundary(seen);
                 }
                 {
                   const Stopwatch watch(times.fill);
                   const bool bare = boundary.blocks().block_count() == 0;
                   if (bare && boundary.box().empty()) return drafts;
                   if (bare) {
                     const std::optional<bool> is_inner =
                         voxeliser.inner_throughout(boundary.box());
                     if (is_inner == false) return drafts;
                     if (is_inner == true && boundary.box() == seen) {
                       draft_inner(tile, object.q, drafts);
                       return drafts;
                     }
                   }
                   inner = voxeliser.inner(boundary);
                 }
                 const Stopwatch watch(times.rank);
                 LayerBricks& bricks = memory.local();
                 bricks.start(tile, object.m, object.q);
                 bricks.put_boundary(boundary);
                 bricks.put_inner(inner);
                 bricks.rank(element);
                 draft(bricks, object.q, drafts);
                 return drafts;
               });
  return array;
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

/// The voxels of one block, 64 x 8 x 8, of an object that keeps distances.
struct DistanceRow {
  std::array<VoxelCode, 4096> codes;
  std::array<std::uint16_t, 4096> steps;

  void lay(const VoxelSet& voxels, const BlockIndex& at, unsigned code,
           const DistanceBlock* distances) {
    const BitBlock* bits = voxels.blocks().find(at);
    if (bits == nullptr) return;
    for (std::size_t row = 0; row < 64; ++row) {
      for_each_run(bits->words[row], [&](std::size_t first, std::size_t length) {
        const std::size_t from = row * 64 + first;
        std::fill_n(codes.begin() + from, length, static_cast<VoxelCode>(code));
        if (distances != nullptr)
          std::copy_n(distances->steps.begin() + from, length, steps.begin() + from);
      });
    }
  }

  static std::array<std::uint16_t, 512> brick(const std::array<std::uint16_t, 4096>& row,
                                              std::size_t b) {
    std::array<std::uint16_t, 512> cut;
    for (std::size_t r = 0; r < 64; ++r)
      std::copy_n(row.begin() + r * 64 + b * 8, 8, cut.begin() + r * 8);
    return cut;
  }
};

/// Ranked by distance, and the distance kept.
ObjectVoxelArray distance_array(const SceneObject& object, const TriangleMesh& mesh,
                                const Workspace& workspace, const Voxeliser& voxeliser,
                                StageTimes& times, const std::function<void(double)>& onward) {
  VoxelSet boundary, inner;
  DistanceLayers layers;
  {
    const Stopwatch watch(times.voxelise);
    boundary = voxeliser.boundary(voxeliser.box());
  }
  {
    const Stopwatch watch(times.fill);
    inner = voxeliser.inner(boundary);
  }
  {
    const Stopwatch watch(times.rank);
    layers = distance_layers(mesh, boundary, inner, workspace, object.m, object.q);
  }
  // A voxel takes a rank by its centre, which may lie half a diagonal further out than the layer.
  const VoxelBox box = voxeliser.box().grown(object.q * object.m + 1);
  ObjectVoxelArray array(box, object.q, true);
  const VoxelIndex lo = array.lo(), size = array.size();
  put_in_order(static_cast<std::size_t>(size.j) * static_cast<std::size_t>(size.k), array, onward,
               [&](std::size_t n) {
                 const Stopwatch watch(times.rank);
                 Drafts drafts;
                 const auto row = std::make_unique<DistanceRow>();
                 const VoxelIndex at = {0, lo.j + static_cast<std::int32_t>(n) % size.j,
                                        lo.k + static_cast<std::int32_t>(n) / size.j};
                 for (std::int32_t i = lo.i; i < lo.i + size.i; ++i) {
                   Drafts::Region* region = nullptr;
                   for (std::int32_t r = 0; r < 64; ++r) {
                     const BlockIndex b = {i, at.j * 8 + (r & 7), at.k * 8 + (r >> 3)};
                     const DistanceBlock* distances = layers.distances.find(b);
                     if (distances == nullptr && inner.blocks().find(b) == nullptr &&
                         boundary.blocks().find(b) == nullptr) {
                       continue;
                     }
                     row->codes.fill(object_code::empty);
                     row->steps.fill(no_distance);
                     row->lay(boundary, b, object_code::boundary, distances);
                     row->lay(inner, b, object_code::inner, nullptr);
                     for (int rank = 1; rank <= object.q; ++rank) {
                       row->lay(layers.neighbours.ranks[static_cast<std::size_t>(rank - 1)], b,
                                object_code::of_rank(rank), distances);
                     }
                     if (region == nullptr) region = &drafts.add({i, at.j, at.k}, object.q);
                     for (const VoxelCode code : row->codes) ++region->counts[code];
                     for (std::size_t brick = 0; brick < 8; ++brick) {
                       const std::size_t place = static_cast<std::size_t>(r) * 8 + brick;
                       region->draft.put_codes(place, DistanceRow::brick(row->codes, brick));
                       region->draft.put_distances(place, DistanceRow::brick(row->steps, brick));
                     }
                   }
                 }
                 return drafts;
               });
  return array;
}

}  // namespace

ObjectVoxelArray::ObjectVoxelArray(const VoxelBox& box, int q, bool keeps_distance)
    : lo_(region_of(box.lo)),
      size_([&] {
        if (box.empty()) return VoxelIndex{};
        const VoxelIndex last = region_of({box.hi.i - 1, box.hi.j - 1, box.hi.k - 1});
        return VoxelIndex{last.i - lo_.i + 1, last.j - lo_.j + 1, last.k - lo_.k + 1};
      }()),
      codes_(static_cast<std::size_t>(size_.i) * static_cast<std::size_t>(size_.j) *
                 static_cast<std::size_t>(size_.k),
             FieldReference::brick_unit, object_code::empty),
      counts_(object_code::count(q)) {
  if (keeps_distance)
    distances_.emplace(codes_.root().size(), 512 * sizeof(std::uint16_t), no_distance);
}

void ObjectVoxelArray::put(const VoxelIndex& region, const RegionDraft& draft,
                           std::span<const std::uint64_t> counts) {
  const std::size_t cell = cell_of(region);
  const std::uint32_t reference = codes_.put(draft.codes());
  codes_.set(cell, reference);
  if (distances_) distances_->set(cell, distances_->put(draft.distances()));
  if (!FieldReference::is_uniform(reference) && reference == region_counts_.size()) {
    VoxelCounts& kinds = region_counts_.emplace_back();
    kinds.boundary = counts[object_code::boundary];
    kinds.inner = counts[object_code::inner];
    for (std::size_t code = object_code::inner + 1; code < counts.size(); ++code)
      kinds.neighbour += counts[code];
  }
  for (std::size_t code = 0; code < counts.size(); ++code) counts_[code] += counts[code];
}

VoxelCounts ObjectVoxelArray::counts_of(std::uint32_t reference) const noexcept {
  if (!FieldReference::is_uniform(reference)) return region_counts_[reference];
  constexpr std::uint64_t all = 64 * 64 * 64;
  switch (static_cast<VoxelCode>(reference)) {
    case object_code::empty:
      return {};
    case object_code::boundary:
      return {.boundary = all};
    case object_code::inner:
      return {.inner = all};
    default:
      return {.neighbour = all};
  }
}

ObjectVoxelArray object_voxel_array(const SceneObject& object, const TriangleMesh& mesh,
                                    const Workspace& workspace, StageTimes& times,
                                    const std::function<void(double done)>& onward) {
  std::optional<Voxeliser> voxeliser;
  {
    const Stopwatch watch(times.voxelise);
    voxeliser.emplace(mesh, workspace, object.boundary, object.inner);
  }
  return object.layers == LayerShape::distance
             ? distance_array(object, mesh, workspace, *voxeliser, times, onward)
             : ranked_array(object, *voxeliser, times, onward);
}

}  // namespace vicinity
