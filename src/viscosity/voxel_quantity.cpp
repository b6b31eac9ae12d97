// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/voxel_quantity.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "vicinity/geometry/error.h"

namespace vicinity {

static_assert(std::endian::native == std::endian::little, "the exports are little-endian");

const char* to_string(VoxelQuantity quantity) noexcept {
  switch (quantity) {
    case VoxelQuantity::rank:
      return "rank";
    case VoxelQuantity::viscosity:
      return "viscosity";
    case VoxelQuantity::object:
      return "object";
    case VoxelQuantity::distance:
      return "distance";
  }
  return "";
}

std::size_t size_of(VoxelQuantity quantity) noexcept {
  return quantity == VoxelQuantity::rank || quantity == VoxelQuantity::object ? 2 : 4;
}

VoxelBox voxels_within(const Workspace& grid, const Box& box) noexcept {
  const Vec3 lo = grid.to_grid(box.min()), hi = grid.to_grid(box.max());
  const auto first = [](double g, std::int32_t n) {
    return static_cast<std::int32_t>(std::clamp(std::floor(g + 1e-6), 0.0, static_cast<double>(n)));
  };
  const auto last = [](double g, std::int32_t n) {
    return static_cast<std::int32_t>(std::clamp(std::ceil(g - 1e-6), 0.0, static_cast<double>(n)));
  };
  const VoxelIndex& dims = grid.dims;
  return {{first(lo.x(), dims.i), first(lo.y(), dims.j), first(lo.z(), dims.k)},
          {last(hi.x(), dims.i), last(hi.y(), dims.j), last(hi.z(), dims.k)}};
}

VoxelPlanes::VoxelPlanes(const ViscosityField& field, const VoxelBox& box, VoxelQuantity quantity,
                         Fastest fastest)
    : field_(field), box_(box), quantity_(quantity), fastest_(fastest) {
  if (quantity != VoxelQuantity::distance || field.keeps_distance()) return;
  throw Error({.where = "distance",
               .what = "the field keeps none",
               .hint = "building it with --shape distance, or shape: distance in its scene"});
}

std::int32_t VoxelPlanes::count() const noexcept {
  return fastest_ == Fastest::x ? box_.hi.k - box_.lo.k : box_.hi.i - box_.lo.i;
}

template <class Number, class ValueOf>
void VoxelPlanes::fill(std::int32_t at, ValueOf&& value_of) {
  const auto& [lo, hi] = box_;
  const std::int32_t wide = fastest_ == Fastest::x ? hi.i - lo.i : hi.k - lo.k;
  bytes_.resize(sizeof(Number) * static_cast<std::size_t>(wide) *
                static_cast<std::size_t>(hi.j - lo.j));
  std::byte* to = bytes_.data();
  for (std::int32_t j = lo.j; j < hi.j; ++j) {
    for (std::int32_t n = 0; n < wide; ++n) {
      const VoxelIndex v = fastest_ == Fastest::x ? VoxelIndex{lo.i + n, j, lo.k + at}
                                                  : VoxelIndex{lo.i + at, j, lo.k + n};
      const auto value = static_cast<Number>(value_of(v));
      std::memcpy(to, &value, sizeof value);
      to += sizeof value;
    }
  }
}

const std::vector<std::byte>& VoxelPlanes::plane(std::int32_t at) {
  const auto records = field_.records();
  switch (quantity_) {
    case VoxelQuantity::rank:
      fill<std::int16_t>(at, [&](const VoxelIndex& v) {
        const VoxelRecord& record = records[field_.code_at(v)];
        switch (record.kind) {
          case VoxelKind::boundary:
            return 0;
          case VoxelKind::inner:
            return -2;
          case VoxelKind::neighbour:
            return static_cast<int>(record.rank);
          default:
            return -1;
        }
      });
      break;
    case VoxelQuantity::viscosity:
      if (field_.keeps_distance()) {
        fill<float>(at, [&](const VoxelIndex& v) {
          return field_.at(field_.workspace().centre_of(v)).viscosity;
        });
      } else {
        fill<float>(at,
                    [&](const VoxelIndex& v) { return field_.viscosities()[field_.code_at(v)]; });
      }
      break;
    case VoxelQuantity::object:
      fill<std::int16_t>(at, [&](const VoxelIndex& v) {
        const VoxelRecord& record = records[field_.code_at(v)];
        return record.kind == VoxelKind::empty ? -1 : static_cast<int>(record.object);
      });
      break;
    case VoxelQuantity::distance:
      fill<float>(at, [&](const VoxelIndex& v) {
        const double d = records[field_.code_at(v)].kind == VoxelKind::empty
                             ? -1
                             : field_.at(field_.workspace().centre_of(v)).distance_m;
        return d < 0 ? std::numeric_limits<double>::quiet_NaN() : d;
      });
      break;
  }
  return bytes_;
}

}  // namespace vicinity
