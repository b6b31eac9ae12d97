// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "drag/fields.h"

#include <algorithm>
#include <array>

#include "vicinity/viscosity/field_image.h"

namespace vicinity {
namespace {
const std::vector<double> paper_coding{32, 25, 20, 17, 15, 13};
}

ViscosityField painted_field(const VoxelIndex& dims,
                             const std::function<VoxelRecord(const VoxelIndex&)>& record_of) {
  FieldObject painting;
  painting.name = "painting";
  painting.coding.mu = paper_coding;
  painting.ranks.resize(6);
  const std::vector objects{painting};
  const std::vector<VoxelRecord> records = records_of(objects);
  const auto code_of = [&](const VoxelRecord& record) {
    const auto found = std::find_if(records.begin(), records.end(), [&](const VoxelRecord& other) {
      return other.kind == record.kind && other.rank == record.rank;
    });
    return static_cast<VoxelCode>(found - records.begin());
  };
  FieldWriter writer({Vec3::Zero(), 1, dims}, objects);
  const VoxelIndex regions = writer.region_dims();
  for (int rk = 0; rk < regions.k; ++rk) {
    for (int rj = 0; rj < regions.j; ++rj) {
      for (int ri = 0; ri < regions.i; ++ri) {
        RegionDraft region;
        for (int brick = 0; brick < 512; ++brick) {
          const VoxelIndex lo{64 * ri + 8 * (brick & 7), 64 * rj + 8 * (brick >> 3 & 7),
                              64 * rk + 8 * (brick >> 6)};
          std::array<VoxelCode, 512> codes{};
          for (int n = 0; n < 512; ++n) {
            const VoxelIndex v{lo.i + (n & 7), lo.j + (n >> 3 & 7), lo.k + (n >> 6)};
            if (VoxelBox{{0, 0, 0}, dims}.contains(v)) {
              codes[static_cast<std::size_t>(n)] = code_of(record_of(v));
            }
          }
          region.put_codes(static_cast<std::size_t>(brick), codes);
        }
        writer.append(region);
      }
    }
  }
  return writer.finish({});
}

ViscosityField field_around(const TriangleMesh& mesh, LayerShape layers, double voxel_size, int m,
                            int q) {
  SceneObject object;
  object.name = "object";
  object.shape = mesh;
  object.layers = layers;
  object.m = m;
  object.q = q;
  object.coding.mu = std::vector<double>(paper_coding.begin(), paper_coding.begin() + q);
  Scene scene;
  scene.voxel_size = voxel_size;
  scene.objects = {object};
  return build_field(scene).field;
}

}  // namespace vicinity
