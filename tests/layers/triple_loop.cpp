// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "layers/triple_loop.h"

#include <algorithm>

namespace vicinity::triple_loop {

ObjectVoxelArray ranked_neighbours(const VoxelSet& boundary, const VoxelSet& inner,
                                   LayerShape shape, int m, int q) {
  ObjectVoxelArray ova;
  if (boundary.box().empty()) return ova;
  ova.box = boundary.box().grown(q * m);
  const auto [lo, hi] = ova.box;
  ova.type.assign(static_cast<std::size_t>(hi.i - lo.i) * static_cast<std::size_t>(hi.j - lo.j) *
                      static_cast<std::size_t>(hi.k - lo.k),
                  -1);
  inner.for_each([&](const VoxelIndex& v) {
    if (ova.box.contains(v)) ova.at(v.i, v.j, v.k) = -2;
  });
  boundary.for_each([&](const VoxelIndex& v) { ova.at(v.i, v.j, v.k) = 0; });

  for (int n = 1; n <= q; ++n) {
    for (int k = lo.k; k < hi.k; ++k) {
      for (int j = lo.j; j < hi.j; ++j) {
        for (int i = lo.i; i < hi.i; ++i) {
          if (ova.at(i, j, k) != n - 1) continue;
          // The floating analyser zone. Nothing of rank n - 1 is nearer to the edge of the array
          // than m voxels; clipping it only keeps this oracle safe with any input.
          for (int dk = std::max(-m, lo.k - k); dk <= std::min(m, hi.k - 1 - k); ++dk) {
            for (int dj = std::max(-m, lo.j - j); dj <= std::min(m, hi.j - 1 - j); ++dj) {
              for (int di = std::max(-m, lo.i - i); di <= std::min(m, hi.i - 1 - i); ++di) {
                const bool mask = shape == LayerShape::cube || di * di + dj * dj + dk * dk <= m * m;
                std::int16_t& type = ova.at(i + di, j + dj, k + dk);
                if (mask && type == -1) type = static_cast<std::int16_t>(n);
              }
            }
          }
        }
      }
    }
  }
  return ova;
}

}  // namespace vicinity::triple_loop
