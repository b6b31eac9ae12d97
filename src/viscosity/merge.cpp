// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Most regions hold one object or none, and many are alike: an object's region is mapped back once,
// and its twins refer to the same. A brick of one object alone is mapped by its table of codes, its
// packed voxels stay as they are. Only where objects meet are voxels looked at one by one.
//
// Rows of regions are prepared by one thread, made by any, and put in by one, in order: the image
// then is the same for any number of threads, and whatever was taken over from an earlier merge.

#include "merge.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <numeric>
#include <tuple>

#include "code_masks.h"
#include "geometry/whole_loops.h"
#include "image_layers.h"
#include "sparse_layer.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/viscosity/field_image.h"
#include "vicinity/viscosity/packed_brick.h"

namespace vicinity {
namespace {

constexpr std::uint32_t nothing = FieldReference::uniform(0);
constexpr std::uint32_t unknown = 0xffffffff;

using BrickCodes = std::array<VoxelCode, 512>;
using BrickSteps = std::array<std::uint16_t, 512>;

/// The values of a brick: codes, mapped by `of_entry`.
template <class Map>
void unpack(std::uint32_t reference, const std::byte* brick, Map&& of_entry, BrickCodes& codes) {
  if (FieldReference::is_uniform(reference)) {
    codes.fill(of_entry(static_cast<VoxelCode>(reference)));
    return;
  }
  const unsigned width = reference >> FieldReference::width_shift;
  if (width == 4) {
    for (std::size_t v = 0; v < 512; ++v) codes[v] = of_entry(load_16(brick + 2 * v));
    return;
  }
  std::array<VoxelCode, 256> table;
  const std::size_t entries = table_size(brick, width);
  for (std::size_t n = 0; n < entries; ++n)
    table[n] = of_entry(load_16(brick + (std::size_t{64} << width) + 2 * n));
  for (std::size_t v = 0; v < 512; ++v) codes[v] = table[packed_code(brick, width, v)];
}

/// An object in a region of the workspace.
struct Presence {
  std::size_t object;
  std::uint32_t codes, distances;  // references of its own array
};

/// What became of the first of all regions where the same regions of the same objects meet.
struct Twin {
  std::uint32_t reference = unknown;
  VoxelCounts counts;
};

/// What becomes of one region of a row.
struct Item {
  enum class Kind {
    as_before,  // taken over from the earlier merge
    alone,      // one object's, all of it in the workspace
    together,   // several objects', all of it in the workspace
    made,       // put together from its bricks: at the edge of the workspace, or with distances
  };
  Kind kind = Kind::made;
  std::size_t cell = 0;
  VoxelIndex at;
  std::vector<Presence> present;
  bool is_first = false;  // of its twins: to be drafted
  Twin* twin = nullptr;   // where several objects are together
  std::unique_ptr<RegionDraft> draft;
  VoxelCounts counts;
};
using Row = std::vector<Item>;

class Merge {
 public:
  Merge(const Workspace& workspace, const std::vector<FieldObject>& objects,
        const std::vector<const ObjectVoxelArray*>& arrays, const EarlierMerge* earlier)
      : workspace_(workspace),
        objects_(objects),
        arrays_(arrays),
        earlier_(earlier),
        writer_(workspace, objects),
        records_(records_of(objects)),
        seen_(arrays.size()),
        twins_(arrays.size()) {
    VoxelCode code = 0;
    for (std::size_t o = 0; o < objects.size(); ++o) {
      offsets_.push_back(code);  // of an object's own codes
      code = static_cast<VoxelCode>(code + 2 + objects[o].q);
      seen_[o].assign(arrays[o]->codes().region_count(), false);
      twins_[o].assign(arrays[o]->codes().region_count(), unknown);
    }
    put_precedence();
    if (earlier != nullptr) {
      const auto image = earlier->merged.field.image();
      codes_before_ = TakenOver(layer_of_image(image, false), FieldReference::brick_unit);
      writer_.codes().reserve(codes_before_.layer.regions.size_bytes(),
                              codes_before_.layer.bricks.size());
      if (writer_.distances() != nullptr) {
        distances_before_ = TakenOver(layer_of_image(image, true), 512 * sizeof(std::uint16_t));
      }
    }
  }

  const VoxelIndex& dims() const noexcept { return writer_.region_dims(); }

  /// Says what is to be done in the row of regions (j, k). One thread, rows in order.
  Row prepare(std::int32_t j, std::int32_t k) {
    Row row;
    std::vector<std::size_t> near;
    for (std::size_t o = 0; o < arrays_.size(); ++o) {
      const VoxelIndex lo = arrays_[o]->lo(), size = arrays_[o]->size();
      if (j >= lo.j && j < lo.j + size.j && k >= lo.k && k < lo.k + size.k) near.push_back(o);
    }
    for (std::int32_t i = 0; i < dims().i; ++i) {
      const std::size_t cell = (static_cast<std::size_t>(k) * static_cast<std::size_t>(dims().j) +
                                static_cast<std::size_t>(j)) *
                                   static_cast<std::size_t>(dims().i) +
                               static_cast<std::size_t>(i);
      Item item;
      item.cell = cell;
      item.at = {i, j, k};
      if (earlier_ != nullptr && !earlier_->changed[cell]) {
        if (codes_before_.layer.root[cell] == nothing) continue;
        item.kind = Item::Kind::as_before;
        row.push_back(std::move(item));
        continue;
      }
      for (const std::size_t o : near) {
        const ObjectVoxelArray& array = *arrays_[o];
        if (!array.holds(item.at)) continue;
        const std::size_t own = array.cell_of(item.at);
        const std::uint32_t codes = array.codes().root()[own];
        if (codes == nothing) continue;
        item.present.push_back(
            {o, codes, array.distances() == nullptr ? 0 : array.distances()->root()[own]});
      }
      if (item.present.empty()) continue;
      const Presence& first = item.present.front();
      const bool is_plain =
          is_whole(item.at) && std::ranges::all_of(item.present, [&](const Presence& p) {
            return arrays_[p.object]->distances() == nullptr;
          });
      if (is_plain && item.present.size() == 1) {
        item.kind = Item::Kind::alone;
        if (!FieldReference::is_uniform(first.codes)) {
          item.is_first = !seen_[first.object][first.codes];
          seen_[first.object][first.codes] = true;
        }
      } else if (is_plain) {
        item.kind = Item::Kind::together;
        std::vector<std::uint64_t> key;
        for (const Presence& p : item.present)
          key.push_back(std::uint64_t{p.object} << 32 | p.codes);
        const auto [twin, is_new] = meetings_.try_emplace(std::move(key));
        item.twin = &twin->second;
        item.is_first = is_new;
      }
      row.push_back(std::move(item));
    }
    return row;
  }

  /// Drafts what is new in a row. Any thread.
  void make(Row& row) const {
    for (Item& item : row) {
      if (item.kind == Item::Kind::made || item.is_first) {
        item.draft = std::make_unique<RegionDraft>();
        for (std::size_t b = 0; b < 512; ++b) make_brick(item, b);
      }
    }
  }

  /// Puts a row into the field. One thread, rows in order.
  void put(const Row& row) {
    SparseLayer& codes = writer_.codes();
    for (const Item& item : row) {
      if (item.kind == Item::Kind::as_before) {
        take_over(item.cell);
        continue;
      }
      const Presence& first = item.present.front();
      std::uint32_t reference;
      VoxelCounts counts = item.counts;
      if (item.kind == Item::Kind::alone) {
        counts = arrays_[first.object]->counts_of(first.codes);
        if (FieldReference::is_uniform(first.codes)) {
          reference =
              FieldReference::uniform(mapped(first.object, static_cast<VoxelCode>(first.codes)));
        } else {
          std::uint32_t& twin = twins_[first.object][first.codes];
          if (item.is_first) twin = codes.put(item.draft->codes());
          reference = twin;
        }
      } else if (item.kind == Item::Kind::together) {
        if (item.is_first) *item.twin = {codes.put(item.draft->codes()), item.counts};
        reference = item.twin->reference;
        counts = item.twin->counts;
      } else {
        reference = codes.put(item.draft->codes());
        if (SparseLayer* distances = writer_.distances())
          distances->set(item.cell, distances->put(item.draft->distances()));
      }
      set(item.cell, reference, counts);
    }
  }

  MergedField finish() {
    MergedField merged;
    merged.field = writer_.finish(counts_);
    merged.region_counts = std::move(region_counts_);
    return merged;
  }

 private:
  /// A layer of the earlier field, and where its parts have gone.
  struct TakenOver {
    TakenOver() = default;
    TakenOver(const ImageLayer& from, std::size_t brick_unit)
        : layer(from),
          unit(brick_unit),
          regions(from.regions.size() / 512, unknown),
          bricks(from.bricks.size() / brick_unit, unknown) {}

    std::uint32_t put(std::uint32_t reference, SparseLayer& into) {
      if (FieldReference::is_uniform(reference)) return reference;
      std::uint32_t& known = regions[reference];
      if (known != unknown) return known;
      std::array<std::uint32_t, 512> region;
      for (std::size_t b = 0; b < 512; ++b) {
        region[b] = put_brick(layer.regions[std::size_t{reference} * 512 + b], into);
      }
      return known = into.put(region);
    }

    std::uint32_t put_brick(std::uint32_t reference, SparseLayer& into) {
      if (FieldReference::is_uniform(reference)) return reference;
      const std::size_t number = reference & FieldReference::number_mask;
      std::uint32_t& known = bricks[number];
      if (known != unknown) return known;
      const std::byte* const brick = layer.bricks.data() + number * unit;
      const unsigned width = reference >> FieldReference::width_shift;
      const std::size_t size =
          unit != FieldReference::brick_unit
              ? unit
              : brick_size(width, table_size(brick, width), FieldReference::brick_unit);
      const std::span bytes(brick, size);
      return known = into.bricks().put(bytes, width, short_hash(bytes));
    }

    ImageLayer layer;
    std::size_t unit = 0;
    HugeVector<std::uint32_t> regions, bricks;  // -> reference in the new field
  };

  void take_over(std::size_t cell) {
    const std::uint32_t before = codes_before_.layer.root[cell];
    const std::uint32_t reference = codes_before_.put(before, writer_.codes());
    if (SparseLayer* distances = writer_.distances()) {
      distances->set(cell, distances_before_.put(distances_before_.layer.root[cell], *distances));
    }
    VoxelCounts counts;
    if (!FieldReference::is_uniform(before)) {
      counts = earlier_->merged.region_counts[before];
    } else {
      add(counts, static_cast<VoxelCode>(before), 64 * 64 * 64);
    }
    set(cell, reference, counts);
  }

  void set(std::size_t cell, std::uint32_t reference, const VoxelCounts& counts) {
    writer_.codes().set(cell, reference);
    if (!FieldReference::is_uniform(reference) && reference == region_counts_.size())
      region_counts_.push_back(counts);
    counts_.boundary += counts.boundary;
    counts_.inner += counts.inner;
    counts_.neighbour += counts.neighbour;
  }

  void add(VoxelCounts& counts, VoxelCode code, std::uint64_t voxels) const noexcept {
    switch (records_[code].kind) {
      case VoxelKind::boundary:
        counts.boundary += voxels;
        break;
      case VoxelKind::inner:
        counts.inner += voxels;
        break;
      case VoxelKind::neighbour:
        counts.neighbour += voxels;
        break;
      case VoxelKind::empty:
        break;
    }
  }

  // Boundary beats inner beats neighbour, then the higher viscosity, then the object that comes
  // first: codes in this order, so that the winner of a voxel is a maximum.
  void put_precedence() {
    std::vector<VoxelCode> order(records_.size());
    std::iota(order.begin(), order.end(), VoxelCode{0});
    const auto key = [&](VoxelCode code) {
      const VoxelRecord& record = records_[code];
      const double viscosity = record.kind == VoxelKind::empty ? 0 : viscosity_of(record);
      return std::tuple(record.kind, viscosity, -int{record.object});
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](VoxelCode a, VoxelCode b) { return key(a) < key(b); });
    precedence_.resize(order.size());
    for (std::size_t n = 0; n < order.size(); ++n)
      precedence_[order[n]] = static_cast<VoxelCode>(n);
    by_precedence_ = std::move(order);
  }

  double viscosity_of(const VoxelRecord& record) const {
    const Coding& coding = objects_[record.object].coding;
    return record.kind == VoxelKind::neighbour ? coding.of_rank(record.rank) : coding.skin;
  }

  VoxelCode mapped(std::size_t object, VoxelCode own) const noexcept {
    return own == 0 ? VoxelCode{0} : static_cast<VoxelCode>(own + offsets_[object]);
  }

  /// Whether no voxel of the region lies beyond the workspace.
  bool is_whole(const VoxelIndex& region) const noexcept {
    const VoxelIndex& d = workspace_.dims;
    return region.i * 64 + 64 <= d.i && region.j * 64 + 64 <= d.j && region.k * 64 + 64 <= d.k;
  }

  void make_brick(Item& item, std::size_t b) const {
    const Presence* only = nullptr;
    std::size_t count = 0;
    bool by_distance = false;
    for (const Presence& p : item.present) {
      if (brick_codes(p, b) == nothing) continue;
      by_distance |= arrays_[p.object]->distances() != nullptr;
      only = &p;
      ++count;
    }
    if (count == 0) return;
    const bool is_cut = !is_whole(item.at) && cut_size(item.at, b) < 512;
    if (!by_distance) {
      if (count == 1 && !is_cut) return map_brick(item, b, *only);
      if (contest_by_masks(item, b, is_cut)) return;
    }

    BrickCodes codes;
    if (by_distance) {
      BrickSteps steps;
      contest_by_distance(item, b, codes, steps);
      if (is_cut) cut(item.at, b, codes, steps);
      item.draft->put_distances(b, steps);
    } else {
      contest(item, b, codes);
      BrickSteps unused{};
      if (is_cut) cut(item.at, b, codes, unused);
    }
    item.draft->put_codes(b, codes);
    for (const VoxelCode code : codes) add(item.counts, code, 1);
  }

  std::uint32_t brick_codes(const Presence& p, std::size_t b) const noexcept {
    if (FieldReference::is_uniform(p.codes)) return p.codes;
    return arrays_[p.object]->codes().region(p.codes)[b];
  }

  /// A brick of one object alone: only its table changes.
  void map_brick(Item& item, std::size_t b, const Presence& only) const {
    const std::size_t object = only.object;
    const std::uint32_t codes = brick_codes(only, b);
    if (FieldReference::is_uniform(codes)) {
      const VoxelCode code = mapped(object, static_cast<VoxelCode>(codes));
      item.draft->put_uniform(b, code);
      if (item.kind != Item::Kind::alone) add(item.counts, code, 512);
      return;
    }
    const std::byte* const brick = arrays_[object]->codes().brick(codes);
    const unsigned width = codes >> FieldReference::width_shift;
    const std::size_t entries = table_size(brick, width);
    const std::size_t size = brick_size(width, entries, FieldReference::brick_unit);
    alignas(8) std::array<std::byte, 2048> bytes;
    std::copy_n(brick, size, bytes.begin());
    for (std::size_t n = 0; n < entries; ++n) {
      std::byte* const entry = bytes.data() + (std::size_t{64} << width) + 2 * n;
      const VoxelCode code = mapped(object, load_16(entry));
      std::memcpy(entry, &code, sizeof(code));
    }
    item.draft->put_packed(b, width, std::span(bytes).first(size));
    if (item.kind == Item::Kind::alone) return;  // its object has counted
    CodeMasks masks;
    if (split(codes, brick, masks)) {
      for (std::size_t n = 0; n < masks.count(); ++n)
        add(item.counts, mapped(object, masks.codes()[n]), vicinity::count(masks.mask(n)));
      return;
    }
    BrickCodes all;
    unpack(
        codes, brick, [&](VoxelCode own) { return mapped(object, own); }, all);
    for (const VoxelCode code : all) add(item.counts, code, 1);
  }

  /// Settles all voxels of a brick at once: codes take what they can of the workspace's voxels,
  /// highest precedence first.
  /// @return  false where there are too many codes
  bool contest_by_masks(Item& item, std::size_t b, bool is_cut) const {
    CodeMasks claims;  // by precedence
    // Where the workspace cuts the brick, what lies beyond is empty: one code more may win.
    const std::size_t most = CodeMasks::most - (is_cut ? 1 : 0);
    for (const Presence& p : item.present) {
      const std::uint32_t codes = brick_codes(p, b);
      if (codes == nothing) continue;
      CodeMasks own;
      if (!split(codes, arrays_[p.object]->codes().brick(codes), own)) return false;
      if (claims.count() + own.count() > most) return false;
      for (std::size_t n = 0; n < own.count(); ++n) {
        if (own.codes()[n] == 0) continue;
        claims.push(precedence_[mapped(p.object, own.codes()[n])], own.mask(n));
      }
    }
    claims.sort();
    BrickBits open, empty;
    open.words.fill(~std::uint64_t{0});
    empty = open;
    if (is_cut) open = within(item.at, b);
    CodeMasks winners;
    for (std::size_t n = claims.count(); n-- > 0;) {
      BrickBits won;
      for (std::size_t k = 0; k < 8; ++k) {
        won.words[k] = claims.mask(n).words[k] & open.words[k];
        open.words[k] &= ~won.words[k];
        empty.words[k] &= ~won.words[k];
      }
      if (!won.any()) continue;
      const VoxelCode code = by_precedence_[claims.codes()[n]];
      winners.push(code, won);
      add(item.counts, code, vicinity::count(won));
    }
    if (empty.any()) winners.push(0, empty);
    winners.sort();
    item.draft->put_masks(b, winners);
    return true;
  }

  /// Who wins each voxel of a brick, by the precedence of codes.
  void contest(const Item& item, std::size_t b, BrickCodes& winners) const {
    winners.fill(0);
    BrickCodes rivals;
    for (const Presence& p : item.present) {
      const std::uint32_t codes = brick_codes(p, b);
      if (codes == nothing) continue;
      unpack(
          codes, arrays_[p.object]->codes().brick(codes),
          [&](VoxelCode own) { return precedence_[mapped(p.object, own)]; }, rivals);
      for (std::size_t v = 0; v < 512; ++v) winners[v] = std::max(winners[v], rivals[v]);
    }
    for (VoxelCode& winner : winners) winner = by_precedence_[winner];
  }

  /// The same where the viscosity of some neighbours depends on their distance.
  void contest_by_distance(const Item& item, std::size_t b, BrickCodes& winners,
                           BrickSteps& steps) const {
    winners.fill(0);
    steps.fill(no_distance);
    std::array<double, 512> viscosities{};
    BrickCodes rivals;
    BrickSteps rival_steps;
    for (const Presence& p : item.present) {
      const std::uint32_t codes = brick_codes(p, b);
      if (codes == nothing) continue;
      const FieldObject& object = objects_[p.object];
      const ObjectVoxelArray& array = *arrays_[p.object];
      unpack(
          codes, array.codes().brick(codes), [&](VoxelCode own) { return mapped(p.object, own); },
          rivals);
      rival_steps.fill(no_distance);
      if (array.distances() != nullptr) read_steps(*array.distances(), p.distances, b, rival_steps);
      for (std::size_t v = 0; v < 512; ++v) {
        if (rivals[v] == 0) continue;
        const VoxelRecord& record = records_[rivals[v]];
        const double viscosity =
            array.distances() != nullptr && record.kind == VoxelKind::neighbour
                ? object.coding.at_distance(rival_steps[v] * distance_step_vox - half_diagonal_vox,
                                            object.m, object.q)
                : viscosity_of(record);
        const VoxelKind held = records_[winners[v]].kind;
        if (winners[v] != 0 &&
            (held > record.kind || (held == record.kind && viscosities[v] >= viscosity))) {
          continue;
        }
        winners[v] = rivals[v];
        viscosities[v] = viscosity;
        steps[v] = rival_steps[v];
      }
    }
  }

  static void read_steps(const SparseLayer& distances, std::uint32_t region, std::size_t b,
                         BrickSteps& steps) {
    const std::uint32_t reference =
        FieldReference::is_uniform(region) ? region : distances.region(region)[b];
    if (FieldReference::is_uniform(reference)) {
      steps.fill(static_cast<std::uint16_t>(reference));
    } else {
      std::memcpy(steps.data(), distances.brick(reference), sizeof(steps));
    }
  }

  /// First voxel of a brick.
  static VoxelIndex corner(const VoxelIndex& region, std::size_t b) noexcept {
    const auto at = static_cast<std::int32_t>(b);
    return {region.i * 64 + at % 8 * 8, region.j * 64 + at / 8 % 8 * 8,
            region.k * 64 + at / 64 * 8};
  }

  /// How many voxels of a brick lie in the workspace.
  std::int32_t cut_size(const VoxelIndex& region, std::size_t b) const noexcept {
    const VoxelIndex lo = corner(region, b);
    const VoxelBox in = VoxelBox{lo, {lo.i + 8, lo.j + 8, lo.k + 8}}.within(workspace_.box());
    return in.empty() ? 0 : (in.hi.i - in.lo.i) * (in.hi.j - in.lo.j) * (in.hi.k - in.lo.k);
  }

  /// The voxels of a brick that lie in the workspace.
  BrickBits within(const VoxelIndex& region, std::size_t b) const noexcept {
    const VoxelIndex lo = corner(region, b);
    BrickBits bits;
    for (std::int32_t v = 0; v < 512; ++v) {
      if (workspace_.box().contains({lo.i + v % 8, lo.j + v / 8 % 8, lo.k + v / 64}))
        bits.words[static_cast<std::size_t>(v / 64)] |= std::uint64_t{1} << v % 64;
    }
    return bits;
  }

  /// Takes out what lies beyond the workspace.
  void cut(const VoxelIndex& region, std::size_t b, BrickCodes& codes, BrickSteps& steps) const {
    const VoxelIndex lo = corner(region, b);
    for (std::int32_t v = 0; v < 512; ++v) {
      if (workspace_.box().contains({lo.i + v % 8, lo.j + v / 8 % 8, lo.k + v / 64})) continue;
      codes[static_cast<std::size_t>(v)] = 0;
      steps[static_cast<std::size_t>(v)] = no_distance;
    }
  }

  const Workspace& workspace_;
  const std::vector<FieldObject>& objects_;
  const std::vector<const ObjectVoxelArray*>& arrays_;
  const EarlierMerge* earlier_;
  FieldWriter writer_;
  std::vector<VoxelRecord> records_;
  std::vector<VoxelCode> offsets_;
  std::vector<VoxelCode> precedence_, by_precedence_;
  // Of an object's region. The first is prepare()'s, the second put()'s: they run beside each
  // other.
  std::vector<std::vector<bool>> seen_;
  std::vector<std::vector<std::uint32_t>> twins_;        // its reference in the field
  std::map<std::vector<std::uint64_t>, Twin> meetings_;  // objects and their regions
  TakenOver codes_before_, distances_before_;
  std::vector<VoxelCounts> region_counts_;
  VoxelCounts counts_;
};

}  // namespace

MergedField merge(const Workspace& workspace, const std::vector<FieldObject>& objects,
                  const std::vector<const ObjectVoxelArray*>& arrays, const EarlierMerge* earlier,
                  const std::function<void(double done)>& progress) {
  Merge merge(workspace, objects, arrays, earlier);
  const VoxelIndex dims = merge.dims();
  const std::int64_t last = std::int64_t{dims.j} * dims.k;
  const auto tokens = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) * 4;
  std::int64_t next = 0, done = 0;
  whole::parallel_pipeline(
      tokens,
      tbb::make_filter<void, std::shared_ptr<Row>>(
          tbb::filter_mode::serial_in_order,
          [&](tbb::flow_control& flow) -> std::shared_ptr<Row> {
            if (next == last) {
              flow.stop();
              return nullptr;
            }
            const std::int64_t r = next++;
            return std::make_shared<Row>(merge.prepare(static_cast<std::int32_t>(r % dims.j),
                                                       static_cast<std::int32_t>(r / dims.j)));
          }) &
          tbb::make_filter<std::shared_ptr<Row>, std::shared_ptr<Row>>(
              tbb::filter_mode::parallel,
              [&](std::shared_ptr<Row> row) {
                merge.make(*row);
                return row;
              }) &
          tbb::make_filter<std::shared_ptr<Row>, void>(
              tbb::filter_mode::serial_in_order, [&](const std::shared_ptr<Row>& row) {
                merge.put(*row);
                ++done;
                progress(static_cast<double>(done) / static_cast<double>(last));
              }));
  return merge.finish();
}

}  // namespace vicinity
