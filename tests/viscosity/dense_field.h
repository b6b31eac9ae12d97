// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A field as a plain array: what the sparse one must say, voxel by voxel.
#pragma once

#include <random>
#include <vector>

#include "vicinity/viscosity/field.h"
#include "vicinity/viscosity/field_image.h"

namespace vicinity::test {

struct DenseField {
  Workspace workspace;
  std::vector<FieldObject> objects;
  std::vector<VoxelCode> codes;      // x fastest
  std::vector<std::uint16_t> steps;  // likewise; empty where no object keeps distances

  std::size_t at(const VoxelIndex& v) const;

  /// Some voxels of each kind of brick: uniform, and with few, many and very many codes.
  static DenseField random(std::mt19937& random, bool with_distances);

  ViscosityField sparse() const;
};

}  // namespace vicinity::test
