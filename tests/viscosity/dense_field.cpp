// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "dense_field.h"

#include <array>

#include "seeds.h"

namespace vicinity::test {

std::size_t DenseField::at(const VoxelIndex& v) const {
  const auto i = static_cast<std::size_t>(v.i), j = static_cast<std::size_t>(v.j),
             k = static_cast<std::size_t>(v.k);
  const auto ni = static_cast<std::size_t>(workspace.dims.i);
  const auto nj = static_cast<std::size_t>(workspace.dims.j);
  return (k * nj + j) * ni + i;
}

DenseField DenseField::random(std::mt19937& random, bool with_distances) {
  DenseField field;
  field.workspace.origin = Vec3(real(random, -3, 3), real(random, -3, 3), real(random, -3, 3));
  field.workspace.voxel_size = real(random, 0.001, 0.1);
  VoxelIndex& dims = field.workspace.dims;
  dims = {whole(random, 1, 140), whole(random, 1, 70), whole(random, 1, 70)};

  const int object_count = whole(random, 1, 20);
  std::size_t code_count = 1;
  for (int o = 0; o < object_count; ++o) {
    FieldObject object;
    object.name = "object " + std::to_string(o);
    object.q = whole(random, 0, 32);
    object.layers = with_distances && o % 2 == 0 ? LayerShape::distance : LayerShape::sphere;
    for (int n = 0; n < object.q; ++n) object.coding.mu.push_back(real(random, 0, 40));
    object.ranks.resize(static_cast<std::size_t>(object.q), 7);
    code_count += static_cast<std::size_t>(object.q) + 2;
    field.objects.push_back(object);
  }

  const auto voxels = static_cast<std::size_t>(dims.i) * static_cast<std::size_t>(dims.j) *
                      static_cast<std::size_t>(dims.k);
  field.codes.resize(voxels);
  if (with_distances) field.steps.resize(voxels, no_distance);
  constexpr std::array palettes = {1, 1, 2, 3, 4, 5, 16, 17, 100, 255, 256, 600};
  for (std::int32_t bk = 0; bk < dims.k; bk += 8) {
    for (std::int32_t bj = 0; bj < dims.j; bj += 8) {
      for (std::int32_t bi = 0; bi < dims.i; bi += 8) {
        const int palette = palettes[static_cast<std::size_t>(whole(random, 0, 11))];
        const int first = whole(random, 0, static_cast<int>(code_count) - 1);
        const bool measured = with_distances && whole(random, 0, 2) == 0;
        for (std::int32_t k = bk; k < std::min(bk + 8, dims.k); ++k) {
          for (std::int32_t j = bj; j < std::min(bj + 8, dims.j); ++j) {
            for (std::int32_t i = bi; i < std::min(bi + 8, dims.i); ++i) {
              const std::size_t at = field.at({i, j, k});
              const auto code = static_cast<std::size_t>(first + whole(random, 0, palette - 1));
              field.codes[at] = static_cast<VoxelCode>(code % code_count);
              if (measured) {
                field.steps[at] = static_cast<std::uint16_t>(whole(random, 0, no_distance));
              }
            }
          }
        }
      }
    }
  }
  return field;
}

ViscosityField DenseField::sparse() const {
  FieldWriter writer(workspace, objects);
  const VoxelIndex regions = writer.region_dims();
  for (std::int32_t r = 0; r < regions.i * regions.j * regions.k; ++r) {
    const VoxelIndex corner = {r % regions.i * 64, r / regions.i % regions.j * 64,
                               r / regions.i / regions.j * 64};
    RegionDraft draft;
    for (std::int32_t b = 0; b < 512; ++b) {
      std::array<VoxelCode, 512> brick_codes{};
      std::array<std::uint16_t, 512> brick_steps;
      brick_steps.fill(no_distance);
      for (std::int32_t n = 0; n < 512; ++n) {
        const VoxelIndex v = {corner.i + b % 8 * 8 + n % 8, corner.j + b / 8 % 8 * 8 + n / 8 % 8,
                              corner.k + b / 64 * 8 + n / 64};
        if (!workspace.box().contains(v)) continue;
        brick_codes[static_cast<std::size_t>(n)] = codes[at(v)];
        if (!steps.empty()) brick_steps[static_cast<std::size_t>(n)] = steps[at(v)];
      }
      draft.put_codes(static_cast<std::size_t>(b), brick_codes);
      if (!steps.empty()) draft.put_distances(static_cast<std::size_t>(b), brick_steps);
    }
    writer.append(draft);
  }
  return writer.finish({1, 2, 3});
}

}  // namespace vicinity::test
