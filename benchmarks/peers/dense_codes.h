// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The plain way to hold a field: one byte for each voxel of the room, x fastest.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "vicinity/viscosity/field.h"

namespace vicinity::peers {

class DenseCodes {
 public:
  enum class Pages { usual, huge };

  /// The lower byte of each code.
  DenseCodes(const ViscosityField& field, Pages pages);
  /// The same bytes elsewhere.
  DenseCodes(const DenseCodes& other, Pages pages);

  std::uint8_t at(const VoxelIndex& v) const noexcept { return bytes_[place(v)]; }
  /// at() of each, a group at a time, each line asked for before the first is read.
  void at(std::span<const VoxelIndex> voxels, std::uint8_t* codes) const noexcept;

 private:
  std::size_t place(const VoxelIndex& v) const noexcept {
    return (static_cast<std::size_t>(v.k) * dim_j_ + static_cast<std::size_t>(v.j)) * dim_i_ +
           static_cast<std::size_t>(v.i);
  }

  std::size_t dim_i_, dim_j_, size_;
  std::shared_ptr<std::uint8_t[]> bytes_;
};

}  // namespace vicinity::peers
