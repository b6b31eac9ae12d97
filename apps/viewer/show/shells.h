// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The outer surfaces of a field's layers, as rectangles for display.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vicinity/viscosity/field.h"

namespace vicinity::viewer {

/// A rectangle of a x b faces of cells; laid out as SHELL has it.
struct Quad {
  std::uint16_t i = 0, j = 0, k = 0;  ///< cell that its first face belongs to
  std::uint16_t a = 1, b = 1;         ///< faces along the two axes that lie in it
  std::uint8_t face = 0;              ///< the way it looks: 0 -x, 1 +x, 2 -y, ... 5 +z
  std::uint8_t zero = 0;
  std::uint16_t object = 0;
  std::uint16_t zero_too = 0;
  friend bool operator==(const Quad&, const Quad&) = default;
};
static_assert(sizeof(Quad) == 16);

struct Shells {
  int step = 1;                            ///< voxels along the edge of a cell
  std::vector<std::vector<Quad>> by_rank;  ///< [0] the skin, [n] rank n
};

/// How coarse cells must be for a shell of no more than about so many faces: 1, 2, 4, ...
/// Goes by how many voxels the build counted, not by looking.
int step_for(const ViscosityField& field, double faces);

/// Faces between a cell of rank n and one that is farther out or empty, for every n, equal
/// neighbours merged. A cell is what its middle voxel is, and skin where any of its voxels is
/// boundary or inner, so that no thin wall is lost. What lies beyond the workspace is empty.
/// @param step  a power of two; raised where a cell's index would need more than 16 bits
/// On all cores; the result does not depend on their number.
Shells shells_of(const ViscosityField& field, int step);

}  // namespace vicinity::viewer
