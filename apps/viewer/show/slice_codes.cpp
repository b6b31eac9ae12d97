// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "show/slice_codes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vicinity::viewer {

SliceCodes slice_codes(const ViscosityField& field, int axis, double where, int most_side) {
  const Workspace& workspace = field.workspace();
  const std::array<std::int32_t, 3> dims{workspace.dims.i, workspace.dims.j, workspace.dims.k};
  const auto across = static_cast<std::size_t>(axis);
  const std::size_t first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
  SliceCodes slice;
  slice.where = where;
  const double layer = std::floor((where - workspace.origin[axis]) / workspace.voxel_size);
  if (!(layer >= 0 && layer < dims[across])) return slice;
  slice.index = static_cast<std::int32_t>(layer);
  slice.where = workspace.origin[axis] + workspace.voxel_size * (layer + 0.5);
  const std::int32_t longest = std::max(dims[first], dims[second]);
  slice.step = (longest + most_side - 1) / most_side;
  const auto samples = [&](std::size_t along) {
    return static_cast<std::uint32_t>((dims[along] + slice.step - 1) / slice.step);
  };
  slice.width = samples(first);
  slice.height = samples(second);
  slice.codes.resize(std::size_t{slice.width} * slice.height);
  const auto voxel = [&](std::uint32_t sample, std::size_t along) {
    return std::min(static_cast<std::int32_t>(sample) * slice.step + slice.step / 2,
                    dims[along] - 1);
  };
  std::array<std::int32_t, 3> at{};
  at[across] = slice.index;
  std::size_t n = 0;
  for (std::uint32_t v = 0; v < slice.height; ++v) {
    at[second] = voxel(v, second);
    for (std::uint32_t u = 0; u < slice.width; ++u, ++n) {
      at[first] = voxel(u, first);
      slice.codes[n] = field.code_at({at[0], at[1], at[2]});
    }
  }
  return slice;
}

}  // namespace vicinity::viewer
