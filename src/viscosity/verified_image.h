// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// An image that may hold anything -> its parts, every reference followed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vicinity/viscosity/field.h"

namespace vicinity {

/// A whole, undamaged image: no lookup through these parts can leave it.
struct VerifiedImage {
  /// Root, regions and bricks as they lie in the image.
  struct Layer {
    const std::uint32_t* root = nullptr;
    const std::uint32_t* regions = nullptr;
    const std::byte* bricks = nullptr;
  };

  Workspace workspace;
  VoxelIndex region_dims;
  VoxelCounts counts;
  std::vector<FieldObject> objects;
  std::vector<VoxelRecord> records;
  Layer codes;
  Layer distances;  ///< root is null where no object keeps any
};

/// Errors: throws Error, naming `where`, as ViscosityField::from_image().
VerifiedImage verify_image(std::span<const std::byte> image, const std::string& where);

}  // namespace vicinity
