// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "verified_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/field_image.h"
#include "vicinity/viscosity/packed_brick.h"

namespace vicinity {
namespace {

/// Reads an image that may hold anything.
class ImageReader {
 public:
  ImageReader(std::span<const std::byte> image, const std::string& where)
      : image_(image), where_(where) {}

  /// The header, with every section's place and checksum verified.
  const FieldHeader& header() {
    if (image_.size() < sizeof(FieldHeader)) {
      const bool starts_well = image_.size() >= sizeof(FieldHeader::magic) && magic_is_ours();
      if (!starts_well) refuse_as_other();
      refuse("cut short", fmt::format("{} bytes", image_.size()),
             fmt::format("at least {}", sizeof(FieldHeader)));
    }
    if (!magic_is_ours()) refuse_as_other();
    std::memcpy(&header_, image_.data(), sizeof(header_));
    if (header_.version != FieldHeader::expected_version) {
      refuse("a field of another version", fmt::format("version {}", header_.version),
             fmt::format("version {}", FieldHeader::expected_version));
    }
    FieldHeader unsigned_header = header_;
    unsigned_header.checksum = 0;
    if (checksum_of(std::as_bytes(std::span(&unsigned_header, 1))) != header_.checksum) {
      refuse("damaged", "a wrong checksum of its header");
    }
    if (image_.size() != header_.image_size) {
      refuse(image_.size() < header_.image_size ? "cut short" : "longer than it says",
             fmt::format("{} bytes", image_.size()), fmt::format("{}", header_.image_size));
    }
    if (header_.section_count != 5 && header_.section_count != 8) {
      refuse("damaged", fmt::format("{} sections", header_.section_count), "5 or 8");
    }
    std::size_t end = sizeof(FieldHeader);
    for (std::size_t s = 0; s < header_.section_count; ++s) {
      const FieldSection& section = header_.sections[s];
      const std::size_t start = (end + 63) & ~std::size_t{63};
      if (section.kind != s + 1 || section.offset != start || start > image_.size() ||
          section.size > image_.size() - start) {
        refuse("damaged", fmt::format("section {} out of place", s + 1));
      }
      const auto padding = image_.subspan(end, start - end);
      if (std::any_of(padding.begin(), padding.end(), [](std::byte b) { return b != std::byte{}; }))
        refuse("damaged", fmt::format("bytes before section {} that are not zero", s + 1));
      if (checksum_of(image_.subspan(start, section.size)) != section.checksum) {
        refuse("damaged", fmt::format("a wrong checksum of section {}", s + 1));
      }
      end = start + section.size;
    }
    if (end != image_.size()) refuse("damaged", "bytes behind the last section");
    return header_;
  }

  std::span<const std::byte> section(std::size_t s) const {
    return image_.subspan(header_.sections[s].offset, header_.sections[s].size);
  }

  [[noreturn]] void refuse(const std::string& what, const std::string& found = {},
                           const std::string& expected = {}) const {
    throw Error({.where = where_,
                 .what = "this field is " + what,
                 .found = found,
                 .expected = expected,
                 .hint = "building it again"});
  }

 private:
  bool magic_is_ours() const noexcept {
    return std::memcmp(image_.data(), FieldHeader::expected_magic.data(),
                       sizeof(FieldHeader::magic)) == 0;
  }
  [[noreturn]] void refuse_as_other() const {
    throw Error({.where = where_,
                 .what = "not a viscosity field",
                 .expected = "a file that vicinity build has written"});
  }

  std::span<const std::byte> image_;
  const std::string& where_;
  FieldHeader header_;
};

LayerShape layer_shape(const std::string& word) {
  for (const LayerShape shape : {LayerShape::cube, LayerShape::sphere, LayerShape::distance}) {
    if (word == to_string(shape)) return shape;
  }
  throw std::invalid_argument("layers '" + word + "'");
}

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

/// Fills in grid, counts and objects. Throws std::exception for anything that is not the META of a
/// field.
void read_meta(std::span<const std::byte> bytes, VerifiedImage& meta) {
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  const auto json = nlohmann::json::parse(text, text + bytes.size());
  meta.workspace.voxel_size = json.at("voxel_size").get<double>();
  require(meta.workspace.voxel_size > 0 && std::isfinite(meta.workspace.voxel_size), "voxel_size");
  const auto origin = json.at("origin").get<std::array<double, 3>>();
  meta.workspace.origin = Vec3(origin[0], origin[1], origin[2]);
  require(meta.workspace.origin.allFinite(), "origin");
  const auto dims = json.at("dims").get<std::array<std::int64_t, 3>>();
  for (const std::int64_t dim : dims) require(dim >= 1 && dim <= 1 << 20, "dims");
  meta.workspace.dims = {static_cast<std::int32_t>(dims[0]), static_cast<std::int32_t>(dims[1]),
                         static_cast<std::int32_t>(dims[2])};
  const auto& voxels = json.at("voxels");
  meta.counts = {voxels.at("boundary").get<std::uint64_t>(),
                 voxels.at("inner").get<std::uint64_t>(),
                 voxels.at("neighbour").get<std::uint64_t>()};
  std::set<std::string> names;
  for (const auto& o : json.at("objects")) {
    FieldObject object;
    object.name = o.at("name").get<std::string>();
    require(names.insert(object.name).second, "two objects of one name");
    object.layers = layer_shape(o.at("layers").get<std::string>());
    const auto m = o.at("m").get<std::int64_t>();
    const auto q = o.at("q").get<std::int64_t>();
    require(m >= 1 && m <= 8 && q >= 0 && q <= 32, "m or q");
    object.m = static_cast<int>(m);
    object.q = static_cast<int>(q);
    object.coding.mu = o.at("coding").get<std::vector<double>>();
    object.coding.skin = o.at("skin").get<double>();
    check_coding(object.coding, object.q, "coding");
    object.bound_mm = o.at("bound_mm").get<double>();
    object.closed = o.at("closed").get<bool>();
    object.triangles = o.at("triangles").get<std::uint64_t>();
    object.boundary = o.at("boundary").get<std::uint64_t>();
    object.inner = o.at("inner").get<std::uint64_t>();
    object.ranks = o.at("ranks").get<std::vector<std::uint64_t>>();
    require(object.ranks.size() == static_cast<std::size_t>(q), "ranks");
    meta.objects.push_back(std::move(object));
  }
}

/// Follows every reference of a layer once. Regions and bricks must be numbered by first
/// appearance, which leaves no byte unaccounted for and makes hostile images easy to refuse.
///
/// @param check_value  says whether a uniform value may stand there
/// @param check_brick  check_brick(reference, known bytes) says how many bytes a brick at the end
///                     of the known bytes takes, or zero where it cannot be
template <class CheckValue, class CheckBrick>
bool references_hold(std::span<const std::uint32_t> root, std::span<const std::uint32_t> regions,
                     std::size_t brick_unit, std::size_t bricks_size, CheckValue check_value,
                     CheckBrick check_brick) {
  const auto uniform_holds = [&](std::uint32_t reference) {
    return reference == FieldReference::uniform(static_cast<std::uint16_t>(reference)) &&
           check_value(static_cast<std::uint16_t>(reference));
  };
  std::uint32_t known_regions = 0;
  for (const std::uint32_t reference : root) {
    if (FieldReference::is_uniform(reference)) {
      if (!uniform_holds(reference)) return false;
    } else if (reference > known_regions) {
      return false;
    } else if (reference == known_regions) {
      ++known_regions;
    }
  }
  if (std::size_t{known_regions} * 512 != regions.size()) return false;

  // One more than the width of the brick that starts at each unit; zero where none does.
  std::vector<std::uint8_t> starts(bricks_size / brick_unit);
  std::size_t known_bytes = 0;
  for (const std::uint32_t reference : regions) {
    if (FieldReference::is_uniform(reference)) {
      if (!uniform_holds(reference)) return false;
      continue;
    }
    const std::size_t unit = reference & FieldReference::number_mask;
    const auto mark = static_cast<std::uint8_t>((reference >> FieldReference::width_shift) + 1);
    if (unit * brick_unit == known_bytes) {
      const std::size_t size = check_brick(reference, known_bytes);
      if (size == 0) return false;
      starts[unit] = mark;
      known_bytes += size;
    } else if (unit >= starts.size() || starts[unit] != mark) {
      return false;
    }
  }
  return known_bytes == bricks_size;
}

/// How many bytes the packed brick at the start of `bytes` takes; zero where it is not one, or
/// names a code that is not below `codes`.
std::size_t packed_brick_size(std::span<const std::byte> bytes, unsigned width, std::size_t codes) {
  const std::size_t packed = std::size_t{64} << width;
  if (width > 4 || bytes.size() < packed) return 0;
  const std::size_t entries = table_size(bytes.data(), width);
  const std::size_t size = brick_size(width, entries, FieldReference::brick_unit);
  if (bytes.size() < size) return 0;
  // Without a table, the codes themselves stand in its place.
  const std::size_t first = width == 4 ? 0 : packed;
  for (std::size_t n = 0; n < (width == 4 ? 512 : entries); ++n) {
    if (load_16(bytes.data() + first + n * 2) >= codes) return 0;
  }
  return size;
}

/// A section as references. Sections start at multiples of 64 bytes of an aligned image.
std::span<const std::uint32_t> as_references(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const std::uint32_t*>(bytes.data()), bytes.size() / 4};
}

}  // namespace

VerifiedImage verify_image(std::span<const std::byte> image, const std::string& where) {
  ImageReader reader(image, where);
  const FieldHeader& header = reader.header();

  VerifiedImage verified;
  try {
    read_meta(reader.section(0), verified);
    verified.records = records_of(verified.objects);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    reader.refuse("damaged", fmt::format("a description that does not read ({})", e.what()));
  }
  const auto expected_records = std::as_bytes(std::span(verified.records));
  if (!std::ranges::equal(reader.section(1), expected_records)) {
    reader.refuse("damaged", "records that do not fit its objects");
  }
  const bool keeps_distance =
      std::any_of(verified.objects.begin(), verified.objects.end(),
                  [](const FieldObject& o) { return o.layers == LayerShape::distance; });
  if (keeps_distance != (header.section_count == 8)) {
    reader.refuse("damaged", "distances that do not fit its objects");
  }

  verified.region_dims = regions_along(verified.workspace);
  const std::uint64_t root_size = std::uint64_t{4} *
                                  static_cast<std::uint64_t>(verified.region_dims.i) *
                                  static_cast<std::uint64_t>(verified.region_dims.j) *
                                  static_cast<std::uint64_t>(verified.region_dims.k);
  const auto layer_at = [&](std::size_t first, std::size_t brick_unit, auto check_value,
                            auto check_brick) {
    const auto root = reader.section(first);
    const auto regions = reader.section(first + 1);
    const auto bricks = reader.section(first + 2);
    constexpr std::size_t region_size = 512 * sizeof(std::uint32_t);
    if (root.size() != root_size || regions.size() % region_size != 0 ||
        bricks.size() % brick_unit != 0 ||
        !references_hold(as_references(root), as_references(regions), brick_unit, bricks.size(),
                         check_value, check_brick)) {
      reader.refuse("damaged",
                    fmt::format("references that lead nowhere, in section {}", first + 1));
    }
    return VerifiedImage::Layer{as_references(root).data(), as_references(regions).data(),
                                bricks.data()};
  };
  const std::size_t codes = verified.records.size();
  const auto packed = reader.section(4);
  verified.codes = layer_at(
      2, FieldReference::brick_unit, [&](std::uint16_t code) { return code < codes; },
      [&](std::uint32_t reference, std::size_t at) {
        return packed_brick_size(packed.subspan(at), reference >> FieldReference::width_shift,
                                 codes);
      });
  if (keeps_distance) {
    constexpr std::size_t brick_size = 512 * sizeof(std::uint16_t);
    const std::size_t bricks_size = reader.section(7).size();
    verified.distances = layer_at(
        5, brick_size, [](std::uint16_t) { return true; },
        [&](std::uint32_t reference, std::size_t at) {
          const bool holds =
              reference <= FieldReference::number_mask && brick_size <= bricks_size - at;
          return holds ? brick_size : 0;
        });
  }
  return verified;
}

}  // namespace vicinity
