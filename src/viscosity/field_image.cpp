// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/field_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "sparse_layer.h"
#include "vicinity/geometry/error.h"
#include "vicinity/voxel/huge_pages.h"

namespace vicinity {
namespace {

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

VoxelIndex regions_along(const Workspace& workspace) noexcept {
  const VoxelIndex& dims = workspace.dims;
  return {(dims.i + 63) >> 6, (dims.j + 63) >> 6, (dims.k + 63) >> 6};
}

void check_region_count(const Workspace& workspace) {
  const VoxelIndex regions = regions_along(workspace);
  if (1.0 * regions.i * regions.j * regions.k <= most_regions) return;
  throw Error({.where = "voxel_size",
               .what = "too small for these bounds",
               .found = fmt::format("{} x {} x {} voxels", workspace.dims.i, workspace.dims.j,
                                    workspace.dims.k),
               .expected = fmt::format("at most {:.0f} regions of 64 x 64 x 64", most_regions),
               .hint = "larger voxels, smaller bounds, or check the units of the meshes"});
}

FieldWriter::FieldWriter(const Workspace& workspace, std::vector<FieldObject> objects)
    : workspace_(workspace),
      objects_(std::move(objects)),
      records_(records_of(objects_)),
      region_dims_(regions_along(workspace)) {
  check_region_count(workspace);
  const std::size_t cells = static_cast<std::size_t>(region_dims_.i) *
                            static_cast<std::size_t>(region_dims_.j) *
                            static_cast<std::size_t>(region_dims_.k);
  codes_ = std::make_unique<SparseLayer>(cells, FieldReference::brick_unit, 0);
  const bool keeps_distance =
      std::any_of(objects_.begin(), objects_.end(),
                  [](const FieldObject& o) { return o.layers == LayerShape::distance; });
  if (keeps_distance) {
    distances_ = std::make_unique<SparseLayer>(cells, 512 * sizeof(std::uint16_t), no_distance);
  }
}

FieldWriter::~FieldWriter() = default;

void FieldWriter::append(const RegionDraft& region) {
  codes_->set(next_, codes_->put(region.codes()));
  if (distances_) distances_->set(next_, distances_->put(region.distances()));
  ++next_;
}

ViscosityField FieldWriter::finish(const VoxelCounts& counts) {
  const std::string meta = meta_json(workspace_, objects_, counts);
  std::vector<std::span<const std::byte>> contents = {std::as_bytes(std::span(meta)),
                                                      std::as_bytes(std::span(records_))};
  std::vector<SharedBytes*> pools = {nullptr, nullptr};
  for (SparseLayer* layer : {codes_.get(), distances_.get()}) {
    if (layer == nullptr) continue;
    contents.push_back(std::as_bytes(layer->root()));
    contents.push_back(layer->regions().bytes());
    contents.push_back(layer->bricks().bytes());
    pools.insert(pools.end(), {nullptr, &layer->regions(), &layer->bricks()});
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

  const std::shared_ptr<std::byte[]> image(static_cast<std::byte*>(take_pages(size)),
                                           give_back_pages);
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
