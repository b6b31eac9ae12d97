// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/field_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

/// Byte strings of a pool, each stored once. A string is named by the reference to it: the width it
/// was put in with, and its position in units.
class SharedBytes {
 public:
  explicit SharedBytes(std::size_t unit) : unit_(unit), slots_(1024) {}

  const std::vector<std::byte>& bytes() const noexcept { return bytes_; }
  void release() noexcept { std::vector<std::byte>().swap(bytes_); }

  /// @param string  a whole number of units
  /// @return        the reference of an equal string put in before, else of a new one
  std::uint32_t put(std::span<const std::byte> string, std::uint32_t width, std::uint32_t hash) {
    if (count_ * 2 >= slots_.size()) grow();
    std::size_t at = hash & (slots_.size() - 1);
    for (; slots_[at].taken; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at].hash == hash && equal(slots_[at].reference, width, string)) {
        return slots_[at].reference;
      }
    }
    const std::size_t number = bytes_.size() / unit_;
    if (number > FieldReference::number_mask) {
      throw Error({.where = "field",
                   .what = "too large for its file format",
                   .expected = fmt::format("at most {} MiB of distinct voxels",
                                           (FieldReference::number_mask + 1ull) * unit_ >> 20),
                   .hint = "larger voxels, fewer ranks or smaller bounds"});
    }
    bytes_.insert(bytes_.end(), string.begin(), string.end());
    slots_[at] = {hash, true,
                  width << FieldReference::width_shift | static_cast<std::uint32_t>(number)};
    ++count_;
    return slots_[at].reference;
  }

 private:
  struct Slot {
    std::uint32_t hash = 0;
    bool taken = false;
    std::uint32_t reference = 0;
  };

  bool equal(std::uint32_t reference, std::uint32_t width,
             std::span<const std::byte> string) const noexcept {
    const std::size_t at = (reference & FieldReference::number_mask) * unit_;
    // A shorter string at the end of the pool cannot be equal; one further in that is equal over
    // the whole length is the same brick, for its packed codes tell how long it is.
    return reference >> FieldReference::width_shift == width &&
           string.size() <= bytes_.size() - at &&
           std::memcmp(bytes_.data() + at, string.data(), string.size()) == 0;
  }

  void grow() {
    std::vector<Slot> old(slots_.size() * 2);
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (!slot.taken) continue;
      std::size_t at = slot.hash & (slots_.size() - 1);
      while (slots_[at].taken) at = (at + 1) & (slots_.size() - 1);
      slots_[at] = slot;
    }
  }

  std::size_t unit_;
  std::size_t count_ = 0;
  std::vector<Slot> slots_;  // open addressing, a power of two of them
  std::vector<std::byte> bytes_;
};

std::uint32_t short_hash(std::span<const std::byte> bytes) noexcept {
  return static_cast<std::uint32_t>(checksum_of(bytes));
}

template <class T>
void append_value(std::vector<std::byte>& bytes, const T& value) {
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(T));
}

std::string meta_json(const Workspace& workspace, const std::vector<FieldObject>& objects,
                      const VoxelCounts& counts) {
  nlohmann::ordered_json meta;
  meta["voxel_size"] = workspace.voxel_size;
  meta["origin"] = {workspace.origin.x(), workspace.origin.y(), workspace.origin.z()};
  meta["dims"] = {workspace.dims.i, workspace.dims.j, workspace.dims.k};
  meta["voxels"] = {
      {"boundary", counts.boundary}, {"inner", counts.inner}, {"neighbour", counts.neighbour}};
  meta["objects"] = nlohmann::ordered_json::array();
  for (const FieldObject& o : objects) {
    const std::vector<double> mu(o.coding.mu.begin(), o.coding.mu.begin() + o.q);
    meta["objects"].push_back({{"name", o.name},
                               {"layers", to_string(o.layers)},
                               {"m", o.m},
                               {"q", o.q},
                               {"coding", mu},
                               {"skin", o.coding.skin},
                               {"bound_mm", o.bound_mm},
                               {"closed", o.closed},
                               {"triangles", o.triangles},
                               {"boundary", o.boundary},
                               {"inner", o.inner},
                               {"ranks", o.ranks}});
  }
  return meta.dump();
}

}  // namespace

std::uint64_t checksum_of(std::span<const std::byte> bytes) noexcept {
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::vector<VoxelRecord> records_of(const std::vector<FieldObject>& objects) {
  std::size_t count = 1;
  for (const FieldObject& object : objects) count += static_cast<std::size_t>(object.q) + 2;
  constexpr std::size_t most = 0x10000;
  if (count > most) {
    throw Error({.where = "objects",
                 .what = "too many ranks for one field",
                 .found = fmt::format("{} kinds of voxel (q + 2 for each object)", count),
                 .expected = fmt::format("at most {}", most),
                 .hint = "fewer ranks, or meshes joined into fewer objects"});
  }
  std::vector<VoxelRecord> records = {{}};
  records.reserve(count);
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const auto object = static_cast<std::uint16_t>(o);
    records.push_back({VoxelKind::boundary, 0, object});
    records.push_back({VoxelKind::inner, 0, object});
    for (int n = 1; n <= objects[o].q; ++n) {
      records.push_back({VoxelKind::neighbour, static_cast<std::uint8_t>(n), object});
    }
  }
  return records;
}

RegionDraft::RegionDraft() {
  codes_.references.fill(FieldReference::uniform(0));
  distances_.references.fill(FieldReference::uniform(no_distance));
}

namespace {

/// Whether all values of a brick are the same: each equals the one behind it.
bool is_uniform(std::span<const std::uint16_t, 512> values) noexcept {
  return std::memcmp(values.data(), values.data() + 1, values.size_bytes() - 2) == 0;
}

}  // namespace

void RegionDraft::put_codes(std::size_t brick, std::span<const VoxelCode, 512> codes) {
  if (is_uniform(codes)) {
    codes_.references[brick] = FieldReference::uniform(codes[0]);
    return;
  }
  std::array<VoxelCode, 512> table;  // distinct codes by first appearance
  std::array<std::uint16_t, 512> packed;
  std::size_t distinct = 0;
  std::size_t latest = 0;  // neighbours along x mostly hold the same code
  for (std::size_t v = 0; v < 512; ++v) {
    if (distinct == 0 || table[latest] != codes[v]) {
      latest = static_cast<std::size_t>(
          std::find(table.begin(), table.begin() + distinct, codes[v]) - table.begin());
      if (latest == distinct) table[distinct++] = codes[v];
    }
    packed[v] = static_cast<std::uint16_t>(latest);
  }
  const std::uint32_t width = distinct <= 2    ? 0
                              : distinct <= 4  ? 1
                              : distinct <= 16 ? 2
                              : distinct < 256 ? 3   // at 256, the table is as long as the codes
                                               : 4;  // 16 bits: the codes themselves
  const std::size_t start = codes_.bytes.size();
  if (width == 4) {
    for (const VoxelCode code : codes) append_value(codes_.bytes, code);
  } else {
    const std::size_t bits = std::size_t{1} << width;
    const std::size_t per_byte = 8 / bits;
    for (std::size_t v = 0; v < 512; v += per_byte) {
      unsigned byte = 0;
      for (std::size_t n = 0; n < per_byte; ++n) byte |= unsigned{packed[v + n]} << (n * bits);
      codes_.bytes.push_back(static_cast<std::byte>(byte));
    }
    for (std::size_t n = 0; n < distinct; ++n) append_value(codes_.bytes, table[n]);
    while (codes_.bytes.size() % FieldReference::brick_unit != 0) codes_.bytes.push_back({});
  }
  codes_.references[brick] = width << FieldReference::width_shift |
                             static_cast<std::uint32_t>(start / FieldReference::brick_unit);
  codes_.hashes[brick] = short_hash(std::span(codes_.bytes).subspan(start));
}

void RegionDraft::put_distances(std::size_t brick, std::span<const std::uint16_t, 512> steps) {
  if (is_uniform(steps)) {
    distances_.references[brick] = FieldReference::uniform(steps[0]);
    return;
  }
  const std::span<const std::byte> bytes = std::as_bytes(steps);
  distances_.references[brick] =
      static_cast<std::uint32_t>(distances_.bytes.size() / FieldReference::brick_unit);
  distances_.hashes[brick] = short_hash(bytes);
  distances_.bytes.insert(distances_.bytes.end(), bytes.begin(), bytes.end());
}

/// Root, regions and bricks of the codes, or of the distances.
struct FieldWriter::Layer {
  explicit Layer(std::size_t brick_unit) : bricks(brick_unit) {}

  void append(const RegionDraft::Layer& draft) {
    std::array<std::uint32_t, 512> region;
    for (std::size_t b = 0; b < 512; ++b) {
      const std::uint32_t reference = draft.references[b];
      if (FieldReference::is_uniform(reference)) {
        region[b] = reference;
        continue;
      }
      const std::size_t start = place_in(draft, b);
      std::size_t next = b + 1;  // bricks lie in the draft one behind the other
      while (next < 512 && FieldReference::is_uniform(draft.references[next])) ++next;
      const std::size_t end = next < 512 ? place_in(draft, next) : draft.bytes.size();
      region[b] = bricks.put(std::span(draft.bytes).subspan(start, end - start),
                             reference >> FieldReference::width_shift, draft.hashes[b]);
    }
    const bool uniform =
        FieldReference::is_uniform(region[0]) &&
        std::all_of(region.begin(), region.end(), [&](std::uint32_t r) { return r == region[0]; });
    const auto bytes = std::as_bytes(std::span(region));
    root.push_back(uniform ? region[0] : regions.put(bytes, 0, short_hash(bytes)));
  }

  static std::size_t place_in(const RegionDraft::Layer& draft, std::size_t brick) {
    return (draft.references[brick] & FieldReference::number_mask) * FieldReference::brick_unit;
  }

  std::vector<std::uint32_t> root;
  SharedBytes regions{512 * sizeof(std::uint32_t)};
  SharedBytes bricks;
};

FieldWriter::FieldWriter(const Workspace& workspace, std::vector<FieldObject> objects)
    : workspace_(workspace), objects_(std::move(objects)), records_(records_of(objects_)) {
  const auto regions = [](std::int32_t voxels) { return (voxels + 63) >> 6; };
  region_dims_ = {regions(workspace.dims.i), regions(workspace.dims.j), regions(workspace.dims.k)};
  const double count = 1.0 * region_dims_.i * region_dims_.j * region_dims_.k;
  constexpr double most = 1 << 27;  // half a GiB of root
  if (count > most) {
    throw Error({.where = "voxel_size",
                 .what = "too small for these bounds",
                 .found = fmt::format("{} x {} x {} voxels", workspace.dims.i, workspace.dims.j,
                                      workspace.dims.k),
                 .expected = fmt::format("at most {:.0f} regions of 64 x 64 x 64", most),
                 .hint = "larger voxels, smaller bounds, or check the units of the meshes"});
  }
  codes_ = std::make_unique<Layer>(FieldReference::brick_unit);
  const bool keeps_distance =
      std::any_of(objects_.begin(), objects_.end(),
                  [](const FieldObject& o) { return o.layers == LayerShape::distance; });
  if (keeps_distance) distances_ = std::make_unique<Layer>(512 * sizeof(std::uint16_t));
}

FieldWriter::~FieldWriter() = default;

void FieldWriter::append(const RegionDraft& region) {
  codes_->append(region.codes_);
  if (distances_) distances_->append(region.distances_);
}

ViscosityField FieldWriter::finish(const VoxelCounts& counts) {
  const std::string meta = meta_json(workspace_, objects_, counts);
  std::vector<std::span<const std::byte>> contents = {std::as_bytes(std::span(meta)),
                                                      std::as_bytes(std::span(records_))};
  std::vector<SharedBytes*> pools = {nullptr, nullptr};
  for (Layer* layer : {codes_.get(), distances_.get()}) {
    if (layer == nullptr) continue;
    contents.push_back(std::as_bytes(std::span(layer->root)));
    contents.push_back(layer->regions.bytes());
    contents.push_back(layer->bricks.bytes());
    pools.insert(pools.end(), {nullptr, &layer->regions, &layer->bricks});
  }

  FieldHeader header;
  header.section_count = static_cast<std::uint32_t>(contents.size());
  std::size_t size = sizeof(FieldHeader);
  for (std::size_t s = 0; s < contents.size(); ++s) {
    size = (size + 63) & ~std::size_t{63};
    header.sections[s] = {static_cast<std::uint32_t>(s + 1), 0, size, contents[s].size(),
                          checksum_of(contents[s])};
    size += contents[s].size();
  }
  header.image_size = size;
  header.checksum = checksum_of(std::as_bytes(std::span(&header, 1)));

  const std::shared_ptr<std::byte[]> image(new std::byte[size]);
  std::memcpy(image.get(), &header, sizeof(header));
  std::size_t written = sizeof(header);
  for (std::size_t s = 0; s < contents.size(); ++s) {
    const std::size_t start = header.sections[s].offset;
    std::fill(image.get() + written, image.get() + start, std::byte{0});
    std::copy(contents[s].begin(), contents[s].end(), image.get() + start);
    written = start + contents[s].size();
    // Pages of the image take memory as they are written: give the same amount back.
    if (pools[s] != nullptr) pools[s]->release();
  }
  return ViscosityField::from_image(image, size, "field");
}

}  // namespace vicinity
