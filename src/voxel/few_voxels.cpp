// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "few_voxels.h"

#include <algorithm>
#include <cmath>

#include "vicinity/geometry/widest_vectors.h"

namespace vicinity {
namespace {

// One number for each of the eight voxels. Lanes by the compiler's own vectors: two to eight
// instructions do for all of them, and where a processor has no vectors it still is C++.
typedef float Lanes __attribute__((vector_size(32)));

constexpr Lanes lane_i{0, 1, 0, 1, 0, 1, 0, 1};
constexpr Lanes lane_j{0, 0, 1, 1, 0, 0, 1, 1};
constexpr Lanes lane_k{0, 0, 0, 0, 1, 1, 1, 1};

// Coordinates are below 2, so that every inequality is off by 1e-6 of its size at most, but for the
// normal, of which a sliver would leave little.
constexpr float margin = 0x1p-13f;
constexpr float sliver = 0.04f;
constexpr float edge_on = margin;

float positive(float x) { return x > 0 ? x : 0; }

}  // namespace

VICINITY_WIDEST_VECTORS
bool few_voxels(const std::array<Vec3, 3>& corners, const VoxelIndex& lo,
                unsigned& voxels) noexcept {
  float p[3][3];
  for (int c = 0; c < 3; ++c) {
    p[c][0] = static_cast<float>(corners[static_cast<std::size_t>(c)].x() - lo.i);
    p[c][1] = static_cast<float>(corners[static_cast<std::size_t>(c)].y() - lo.j);
    p[c][2] = static_cast<float>(corners[static_cast<std::size_t>(c)].z() - lo.k);
  }
  float e[3][3];
  for (int c = 0; c < 3; ++c) {
    for (int a = 0; a < 3; ++a) e[c][a] = p[(c + 1) % 3][a] - p[c][a];
  }
  const float n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                      e[0][0] * e[1][1] - e[0][1] * e[1][0]};
  const float size = std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]);
  const auto length = [&](int c) {
    return std::abs(e[c][0]) + std::abs(e[c][1]) + std::abs(e[c][2]);
  };
  const float longest = std::max(std::max(length(0), length(1)), length(2));
  const float least = std::min(std::min(std::abs(n[0]), std::abs(n[1])), std::abs(n[2]));
  bool clear = size > sliver * longest * longest && least > edge_on * longest;
  // The bounding box must reach into its outer voxels, too.
  for (int a = 0; a < 3; ++a) {
    const float low = std::min(std::min(p[0][a], p[1][a]), p[2][a]);
    const float high = std::max(std::max(p[0][a], p[1][a]), p[2][a]);
    const float above = high - (high >= 1 ? 1.0f : 0.0f);
    clear &= (low < 1 - margin) & (above > margin) & (std::abs(high - 1) > margin);
  }

  // Least, over the axes, of how far triangle and voxel overlap, at least and at most.
  const float d = n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2];
  const Lanes along = n[0] * lane_i + n[1] * lane_j + n[2] * lane_k;
  const Lanes in_front = along + (positive(n[0]) + positive(n[1]) + positive(n[2]) - d);
  const Lanes behind = (d + positive(-n[0]) + positive(-n[1]) + positive(-n[2])) - along;
  Lanes overlap = in_front < behind ? in_front : behind;
  Lanes sure = overlap - margin * size, likely = overlap + margin * size;
  for (int across = 0; across < 3; ++across) {
    const int u = (across + 1) % 3, v = (across + 2) % 3;
    const Lanes& lane_u = u == 0 ? lane_i : u == 1 ? lane_j : lane_k;
    const Lanes& lane_v = v == 0 ? lane_i : v == 1 ? lane_j : lane_k;
    const float turn = std::copysign(1.0f, n[across]);
    for (int c = 0; c < 3; ++c) {
      const float nu = -turn * e[c][v], nv = turn * e[c][u];
      const float least_sum = positive(nu) + positive(nv) - (nu * p[c][u] + nv * p[c][v]);
      const float doubt = margin * (std::abs(nu) + std::abs(nv));
      const Lanes value = nu * lane_u + nv * lane_v + least_sum;
      const Lanes low = value - doubt, high = value + doubt;
      sure = low < sure ? low : sure;
      likely = high < likely ? high : likely;
    }
  }
  unsigned is_sure = 0, is_likely = 0;
  for (int lane = 0; lane < 8; ++lane) {
    is_sure |= static_cast<unsigned>(sure[lane] > 0) << lane;
    is_likely |= static_cast<unsigned>(likely[lane] > 0) << lane;
  }
  voxels = is_sure;
  return clear & (is_sure == is_likely);
}

}  // namespace vicinity
