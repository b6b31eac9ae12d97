// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "volume/voxel_quantity.h"

#include <bit>
#include <cstring>
#include <limits>

namespace vicinity::cli {

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

VoxelPlanes::VoxelPlanes(const ViscosityField& field, const VoxelBox& box, VoxelQuantity quantity,
                         Fastest fastest)
    : field_(field), box_(box), quantity_(quantity), fastest_(fastest) {}

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

}  // namespace vicinity::cli
