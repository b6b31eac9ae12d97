// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "region_lanes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "widest_vectors.h"

namespace vicinity {
namespace {

constexpr std::size_t lanes = 8;

/// Which of eight boxes a region touches, as far as single planes tell; the first box in bit 0.
VICINITY_WIDEST_VECTORS
void find_touched(const NearestRegion* regions, const std::uint32_t* listed, std::size_t count,
                  const EightBoxes& boxes, std::uint8_t* touched) {
  for (std::size_t n = 0; n < count; ++n) {
    const NearestRegion& region = regions[listed[n]];
    float x[lanes], y[lanes], z[lanes], most[lanes];
    for (std::size_t l = 0; l < lanes; ++l) {
      x[l] = boxes.x[l] - region.anchor[0];
      y[l] = boxes.y[l] - region.anchor[1];
      z[l] = boxes.z[l] - region.anchor[2];
      most[l] = 0;
    }
    for (std::size_t p = 0; p < NearestRegion::most_planes; ++p) {
      const float a = region.x[p], b = region.y[p], c = region.z[p];
      const float farthest = region.offset[p] + (std::abs(a) * boxes.half_x + std::abs(b) * boxes.half_y +
                                                 std::abs(c) * boxes.half_z);
      for (std::size_t l = 0; l < lanes; ++l) {
        const float in_front = a * x[l] + b * y[l] + c * z[l] - farthest;
        most[l] = in_front > most[l] ? in_front : most[l];
      }
    }
    std::uint32_t bits = 0;
    for (std::size_t l = 0; l < lanes; ++l) bits |= most[l] > 0 ? 0u : 1u << l;
    touched[n] = static_cast<std::uint8_t>(bits);
  }
}

}  // namespace

void EightLists::fill(std::span<const NearestRegion> regions, std::span<const std::uint32_t> listed,
                      const EightBoxes& boxes) {
  stride_ = listed.size() + 1;
  if (of_box_.size() < 9 * stride_) of_box_.resize(9 * stride_);
  auto* const touched = reinterpret_cast<std::uint8_t*>(&of_box_[8 * stride_]);
  find_touched(regions.data(), listed.data(), listed.size(), boxes, touched);
  std::uint32_t* const of_box = of_box_.data();
  const std::size_t stride = stride_;
  std::array<std::size_t, 8> count{};
  for (std::size_t n = 0; n < listed.size(); ++n) {
    const std::uint32_t id = listed[n];
    const std::uint32_t bits = touched[n];
    for (std::size_t box = 0; box < 8; ++box) {
      of_box[box * stride + count[box]] = id;
      count[box] += (bits >> box) & 1;
    }
  }
  count_ = count;
}

VICINITY_WIDEST_VECTORS
void measure_cell(std::span<const NearestRegion> regions, std::span<const std::uint32_t> listed,
                  float middle_x, float middle_y, float middle_z, CellDistances& distances) {
  constexpr std::size_t plane = 16;
  alignas(64) static constexpr float along_x[plane] = {-1.5f, -.5f, .5f, 1.5f, -1.5f, -.5f, .5f, 1.5f,
                                     -1.5f, -.5f, .5f, 1.5f, -1.5f, -.5f, .5f, 1.5f};
  alignas(64) static constexpr float along_y[plane] = {-1.5f, -1.5f, -1.5f, -1.5f, -.5f, -.5f, -.5f, -.5f,
                                     .5f,  .5f,  .5f,  .5f,  1.5f, 1.5f, 1.5f, 1.5f};
  alignas(64) float squared[cell_voxels];
  for (std::size_t v = 0; v < cell_voxels; ++v) squared[v] = std::numeric_limits<float>::infinity();
  float error = 0;
  for (const std::uint32_t id : listed) {
    const NearestRegion& region = regions[id];
    error = std::max(error, region.error);
    // The middle of the cell as the region sees it.
    const float x = middle_x - region.anchor[0], y = middle_y - region.anchor[1],
                z = middle_z - region.anchor[2];
    const Eigen::Vector3f &d = region.direction, &p = region.point;
    switch (region.kind) {
      case FeatureKind::face: {
        float side[3][plane], away[plane];
        for (std::size_t s = 0; s < 3; ++s) {
          const float at_middle = region.x[s] * x + region.y[s] * y + region.z[s] * z - region.offset[s];
          for (std::size_t l = 0; l < plane; ++l) {
            side[s][l] = at_middle + region.x[s] * along_x[l] + region.y[s] * along_y[l];
          }
        }
        const float at_middle = d[0] * (x - p[0]) + d[1] * (y - p[1]) + d[2] * (z - p[2]);
        for (std::size_t l = 0; l < plane; ++l) {
          away[l] = at_middle + d[0] * along_x[l] + d[1] * along_y[l];
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const float up = static_cast<float>(k) - 1.5f;
          const float s0 = up * region.z[0], s1 = up * region.z[1], s2 = up * region.z[2],
                      s3 = up * d[2];
          float* const to = squared + k * plane;
          for (std::size_t l = 0; l < plane; ++l) {
            const float a = side[0][l] + s0, b = side[1][l] + s1, c = side[2][l] + s2;
            const float s = away[l] + s3;
            const float ab = a > b ? a : b;
            const float out = ab > c ? ab : c;
            const float value = out > 0 ? std::numeric_limits<float>::infinity() : s * s;
            to[l] = value < to[l] ? value : to[l];
          }
        }
        break;
      }
      case FeatureKind::edge: {
        // From the point of the edge nearest to the middle, so that squares stay small.
        const float from_x = x - p[0], from_y = y - p[1], from_z = z - p[2];
        const float at = d[0] * from_x + d[1] * from_y + d[2] * from_z;
        const float foot = std::min(std::max(at, 0.0f), region.length);
        const float fx = from_x - foot * d[0], fy = from_y - foot * d[1], fz = from_z - foot * d[2];
        const float least = -foot, most = region.length - foot;
        float flat[plane], along[plane];
        for (std::size_t l = 0; l < plane; ++l) {
          const float px = fx + along_x[l], py = fy + along_y[l];
          flat[l] = px * px + py * py;
          along[l] = d[0] * px + d[1] * py;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const float pz = fz + (static_cast<float>(k) - 1.5f);
          const float high = pz * pz, along_z = d[2] * pz;
          float* const to = squared + k * plane;
          for (std::size_t l = 0; l < plane; ++l) {
            const float t = along[l] + along_z;
            const float above = t > least ? t : least;
            const float nearest = above < most ? above : most;
            const float value = (flat[l] + high) - nearest * (t + t - nearest);
            to[l] = value < to[l] ? value : to[l];
          }
        }
        break;
      }
      case FeatureKind::vertex: {
        const float fx = x - p[0], fy = y - p[1], fz = z - p[2];
        float flat[plane];
        for (std::size_t l = 0; l < plane; ++l) {
          const float px = fx + along_x[l], py = fy + along_y[l];
          flat[l] = px * px + py * py;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const float pz = fz + (static_cast<float>(k) - 1.5f);
          const float high = pz * pz;
          float* const to = squared + k * plane;
          for (std::size_t l = 0; l < plane; ++l) {
            const float value = flat[l] + high;
            to[l] = value < to[l] ? value : to[l];
          }
        }
        break;
      }
    }
  }
  std::memcpy(distances.squared, squared, sizeof squared);
  distances.error = error;
}

VICINITY_WIDEST_VECTORS
void round_cell(const CellDistances& distances, const Rounding& rounding, RoundedCell& rounded) {
  const Rounding r = rounding;
  const float error = 2 * distances.error;
  alignas(64) std::uint32_t differs[cell_voxels];
  for (std::size_t v = 0; v < cell_voxels; ++v) {
    const float square = distances.squared[v];
    float d = std::sqrt(square > 0 ? square : 0.0f);
    d = d < r.farthest ? d : r.farthest;
    // Squares of edges are differences: off by 1e-5 where they are small, see measure_cell().
    const float off = error + 3e-7f * d + 1.1e-5f / (d > 0.01f ? d : 0.01f);
    const float low = d > off ? d - off : 0.0f, high = d + off;
    const float low_s = low - r.first_rank, high_s = high - r.first_rank;
    const auto low_step = static_cast<std::int32_t>(low * r.steps_per_voxel);
    const auto high_step = static_cast<std::int32_t>(high * r.steps_per_voxel);
    const auto low_rank = static_cast<std::int32_t>((low_s > 0 ? low_s : 0.0f) * r.ranks_per_voxel);
    const auto high_rank =
        static_cast<std::int32_t>((high_s > 0 ? high_s : 0.0f) * r.ranks_per_voxel);
    rounded.steps[v] = static_cast<std::uint16_t>(high_step);
    rounded.ranks[v] = static_cast<std::uint8_t>(high_rank);
    differs[v] = static_cast<std::uint32_t>((low_step ^ high_step) | (low_rank ^ high_rank));
  }
  std::uint64_t unsure = 0;
  for (std::size_t v = 0; v < cell_voxels; ++v) {
    unsure |= std::uint64_t{differs[v] != 0} << v;
  }
  rounded.unsure = unsure;
}

}  // namespace vicinity
