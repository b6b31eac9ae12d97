// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "object_voxel_array.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

#include "code_masks.h"
#include "geometry/whole_loops.h"
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
    VoxelIndex at;  // from the tile's first region
    RegionDraft draft;
    std::vector<std::uint64_t> counts;
    std::optional<ObjectVoxelArray::Reference>
        put;  // once it is in: equal tiles share their drafts
  };
  std::vector<std::unique_ptr<Region>> regions;

  Region& add(const VoxelIndex& at, int q) {
    return *regions.emplace_back(std::make_unique<Region>(
        Region{at, {}, std::vector<std::uint64_t>(object_code::count(q)), {}}));
  }
};

/// Drafts, and where they go.
struct PlacedDrafts {
  VoxelIndex region;  // the tile's first
  std::shared_ptr<Drafts> drafts;
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
  whole::parallel_pipeline(
      tokens, tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                                  [&](tbb::flow_control& flow) {
                                                    if (next == count) flow.stop();
                                                    return next++;
                                                  }) &
                  tbb::make_filter<std::size_t, PlacedDrafts>(
                      tbb::filter_mode::parallel, [&](std::size_t n) { return make(n); }) &
                  tbb::make_filter<PlacedDrafts, void>(
                      tbb::filter_mode::serial_in_order, [&](const PlacedDrafts& made) {
                        if (made.drafts != nullptr) {
                          for (const auto& region : made.drafts->regions) {
                            const VoxelIndex at = {made.region.i + region->at.i,
                                                   made.region.j + region->at.j,
                                                   made.region.k + region->at.k};
                            if (!region->put)
                              region->put = array.put(region->draft, region->counts);
                            array.set(at, *region->put, region->counts);
                          }
                        }
                        onward(static_cast<double>(++done) / static_cast<double>(count));
                      }));
}

/// Gives the bricks of a tile to its regions.
void draft(const LayerBricks& bricks, const VoxelIndex& tile, int q, Drafts& drafts) {
  std::array<Drafts::Region*, tile_regions * tile_regions * tile_regions> made{};
  CodeMasks masks;
  bricks.for_each_brick([&](const BlockIndex& b, std::span<const BrickBits> planes) {
    const VoxelIndex at = {(b.i >> 3) - tile.i, (b.j >> 3) - tile.j, (b.k >> 3) - tile.k};
    Drafts::Region*& region =
        made[static_cast<std::size_t>((at.k * tile_regions + at.j) * tile_regions + at.i)];
    if (region == nullptr) region = &drafts.add(at, q);
    split(planes, masks);
    for (std::size_t n = 0; n < masks.count(); ++n)
      region->counts[masks.codes()[n]] += count(masks.mask(n));
    region->draft.put_masks(static_cast<std::size_t>(((b.k & 7) * 8 + (b.j & 7)) * 8 + (b.i & 7)),
                            masks);
  });
}

/// A tile that is inner throughout.
std::shared_ptr<Drafts> inner_tile(int q) {
  auto drafts = std::make_shared<Drafts>();
  for (std::int32_t r = 0; r < tile_regions * tile_regions * tile_regions; ++r) {
    Drafts::Region& region = drafts->add(
        {r % tile_regions, r / tile_regions % tile_regions, r / tile_regions / tile_regions}, q);
    for (std::size_t b = 0; b < 512; ++b) region.draft.put_uniform(b, object_code::inner);
    region.counts[object_code::inner] = 64 * 64 * 64;
  }
  return drafts;
}

/// The last few tiles and what became of them. Floors, walls and straight pipes look the same tile
/// after tile: those are ranked once.
class LatestTiles {
 public:
  /// The voxels that decide over a tile, seen from its first one.
  class Look {
   public:
    Look(const VoxelIndex& tile, const VoxelSet& boundary, const VoxelSet& inner) {
      take(tile, boundary);
      starts_inner_ = blocks_.size();
      take(tile, inner);
    }
    bool operator==(const Look& other) const {
      return starts_inner_ == other.starts_inner_ && places_ == other.places_ &&
             blocks_ == other.blocks_;
    }

   private:
    void take(const VoxelIndex& tile, const VoxelSet& voxels) {
      voxels.blocks().for_each([&](const BlockIndex& b, const BitBlock& block) {
        places_.push_back({b.i - (tile.i >> 6), b.j - (tile.j >> 3), b.k - (tile.k >> 3)});
        blocks_.push_back(block.words);
      });
    }

    std::size_t starts_inner_;
    std::vector<BlockIndex> places_;
    std::vector<std::array<std::uint64_t, 64>> blocks_;
  };

  /// The drafts of an equal tile; null where none of the last few is.
  std::shared_ptr<Drafts> find(const Look& look) const {
    const std::lock_guard lock(mutex_);
    for (const auto& [known, drafts] : latest_) {
      if (*known == look) return drafts;
    }
    return nullptr;
  }

  void put(Look&& look, const std::shared_ptr<Drafts>& drafts) {
    const std::lock_guard lock(mutex_);
    if (latest_.size() == capacity) latest_.pop_back();
    latest_.emplace_front(std::make_unique<const Look>(std::move(look)), drafts);
  }

 private:
  static constexpr std::size_t capacity = 12;  // half a MiB each, at most a few

  mutable std::mutex mutex_;
  std::deque<std::pair<std::unique_ptr<const Look>, std::shared_ptr<Drafts>>> latest_;
};

/// The tiles that cover a box, x fastest.
class Tiles {
 public:
  explicit Tiles(const VoxelBox& box)
      : lo_{first(box.lo.i), first(box.lo.j), first(box.lo.k)},
        size_{count(lo_.i, box.hi.i), count(lo_.j, box.hi.j), count(lo_.k, box.hi.k)} {}

  std::size_t count() const noexcept {
    return static_cast<std::size_t>(std::int64_t{size_.i} * size_.j * size_.k);
  }
  VoxelBox at(std::size_t n) const noexcept {
    const auto t = static_cast<std::int64_t>(n);
    const VoxelIndex lo = {lo_.i + static_cast<std::int32_t>(t % size_.i) * tile_side,
                           lo_.j + static_cast<std::int32_t>(t / size_.i % size_.j) * tile_side,
                           lo_.k + static_cast<std::int32_t>(t / size_.i / size_.j) * tile_side};
    return {lo, {lo.i + tile_side, lo.j + tile_side, lo.k + tile_side}};
  }

 private:
  static std::int32_t first(std::int32_t lo) noexcept { return lo & ~(tile_side - 1); }
  static std::int32_t count(std::int32_t first, std::int32_t hi) noexcept {
    return (hi - first + tile_side - 1) / tile_side;
  }

  VoxelIndex lo_, size_;
};

/// Boundary and inner voxels of a box.
struct TileVoxels {
  VoxelSet boundary, inner;
  bool is_inner_throughout = false;

  bool empty() const noexcept {
    return boundary.blocks().block_count() == 0 && inner.blocks().block_count() == 0;
  }
};

TileVoxels voxels_of(const Voxeliser& voxeliser, const VoxelBox& box, StageTimes& times) {
  TileVoxels tile;
  {
    const Stopwatch watch(times.voxelise);
    tile.boundary = voxeliser.boundary(box);
  }
  const Stopwatch watch(times.fill);
  if (tile.boundary.box().empty()) return tile;
  if (tile.boundary.blocks().block_count() == 0) {
    const std::optional<bool> is_inner = voxeliser.inner_throughout(tile.boundary.box());
    if (is_inner == false) return tile;
    tile.is_inner_throughout = is_inner == true && tile.boundary.box() == box;
    if (tile.is_inner_throughout) return tile;
  }
  tile.inner = voxeliser.inner(tile.boundary);
  return tile;
}

/// Ranked by a shaping element.
ObjectVoxelArray ranked_array(const SceneObject& object, const Voxeliser& voxeliser,
                              StageTimes& times, const std::function<void(double)>& onward) {
  const ShapingElement element(object.layers, object.m);
  const VoxelBox box = voxeliser.box().grown(object.q * object.m);
  ObjectVoxelArray array(box, object.q, false);
  const Tiles tiles(box);
  tbb::enumerable_thread_specific<LayerBricks> memory;
  LatestTiles latest;
  const auto drafts_of = [&](const VoxelBox& tile) -> std::shared_ptr<Drafts> {
    const TileVoxels voxels =
        voxels_of(voxeliser, tile.grown(LayerBricks::halo(object.m, object.q)), times);
    if (voxels.is_inner_throughout) return inner_tile(object.q);
    if (voxels.empty()) return nullptr;
    const Stopwatch watch(times.rank);
    LatestTiles::Look look(tile.lo, voxels.boundary, voxels.inner);
    if (std::shared_ptr<Drafts> known = latest.find(look)) return known;
    LayerBricks& bricks = memory.local();
    bricks.start(tile, object.m, object.q);
    bricks.put_boundary(voxels.boundary);
    bricks.put_inner(voxels.inner);
    bricks.rank(element);
    auto drafts = std::make_shared<Drafts>();
    draft(bricks, region_of(tile.lo), object.q, *drafts);
    latest.put(std::move(look), drafts);
    return drafts;
  };
  put_in_order(tiles.count(), array, onward, [&](std::size_t n) {
    const VoxelBox tile = tiles.at(n);
    return PlacedDrafts{region_of(tile.lo), drafts_of(tile)};
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

/// Gives the voxels of a tile to its regions.
void draft(const TileVoxels& voxels, const DistanceLayers& layers, const VoxelIndex& tile, int q,
           Drafts& drafts) {
  const auto row = std::make_unique<DistanceRow>();
  for (std::int32_t n = 0; n < tile_regions * tile_regions * tile_regions; ++n) {
    const VoxelIndex at = {n % tile_regions, n / tile_regions % tile_regions,
                           n / tile_regions / tile_regions};
    Drafts::Region* region = nullptr;
    for (std::int32_t r = 0; r < 64; ++r) {
      const BlockIndex b = {tile.i + at.i, (tile.j + at.j) * 8 + (r & 7),
                            (tile.k + at.k) * 8 + (r >> 3)};
      const DistanceBlock* distances = layers.distances.find(b);
      if (distances == nullptr && voxels.inner.blocks().find(b) == nullptr &&
          voxels.boundary.blocks().find(b) == nullptr) {
        continue;
      }
      row->codes.fill(object_code::empty);
      row->steps.fill(no_distance);
      row->lay(voxels.boundary, b, object_code::boundary, distances);
      row->lay(voxels.inner, b, object_code::inner, nullptr);
      for (int rank = 1; rank <= q; ++rank) {
        row->lay(layers.neighbours.ranks[static_cast<std::size_t>(rank - 1)], b,
                 object_code::of_rank(rank), distances);
      }
      if (region == nullptr) region = &drafts.add(at, q);
      for (const VoxelCode code : row->codes) ++region->counts[code];
      for (std::size_t brick = 0; brick < 8; ++brick) {
        const std::size_t place = static_cast<std::size_t>(r) * 8 + brick;
        region->draft.put_codes(place, DistanceRow::brick(row->codes, brick));
        region->draft.put_distances(place, DistanceRow::brick(row->steps, brick));
      }
    }
  }
}

/// Ranked by distance, and the distance kept.
ObjectVoxelArray distance_array(const SceneObject& object, const TriangleMesh& mesh,
                                const Workspace& workspace, const Voxeliser& voxeliser,
                                StageTimes& times, const std::function<void(double)>& onward) {
  std::optional<SurfaceDistances> surface;
  {
    const Stopwatch watch(times.rank);
    surface.emplace(mesh, workspace, object.m, object.q);
  }
  const VoxelBox box = surface->box(voxeliser.box());
  ObjectVoxelArray array(box, object.q, true);
  const Tiles tiles(box);
  put_in_order(tiles.count(), array, onward, [&](std::size_t n) {
    const VoxelBox tile = tiles.at(n);
    PlacedDrafts placed{region_of(tile.lo), nullptr};
    const TileVoxels voxels = voxels_of(voxeliser, tile, times);
    if (voxels.is_inner_throughout) {
      placed.drafts = inner_tile(object.q);
      return placed;
    }
    const Stopwatch watch(times.rank);
    const DistanceLayers layers = surface->layers(voxels.boundary, voxels.inner, tile.within(box));
    placed.drafts = std::make_shared<Drafts>();
    draft(voxels, layers, placed.region, object.q, *placed.drafts);
    return placed;
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

ObjectVoxelArray::Reference ObjectVoxelArray::put(const RegionDraft& draft,
                                                  std::span<const std::uint64_t> counts) {
  const Reference put = {codes_.put(draft.codes()),
                         distances_ ? distances_->put(draft.distances()) : 0};
  if (!FieldReference::is_uniform(put.codes) && put.codes == region_counts_.size()) {
    VoxelCounts& kinds = region_counts_.emplace_back();
    kinds.boundary = counts[object_code::boundary];
    kinds.inner = counts[object_code::inner];
    for (std::size_t code = object_code::inner + 1; code < counts.size(); ++code)
      kinds.neighbour += counts[code];
  }
  return put;
}

void ObjectVoxelArray::set(const VoxelIndex& region, const Reference& reference,
                           std::span<const std::uint64_t> counts) {
  const std::size_t cell = cell_of(region);
  codes_.set(cell, reference.codes);
  if (distances_) distances_->set(cell, reference.distances);
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
