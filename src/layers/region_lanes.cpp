// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "region_lanes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vicinity/geometry/widest_vectors.h"

namespace vicinity {
namespace {

constexpr std::size_t lanes = 8;

/// Which of eight boxes a region touches, as far as single planes tell; the first box in bit 0.
VICINITY_WIDEST_VECTORS
void find_touched(const NearestRegion* regions, std::span<const std::uint32_t> listed,
                  const EightBoxes& boxes, std::uint8_t* touched) {
  constexpr std::size_t planes = NearestRegion::most_planes;
  for (std::size_t n = 0; n < listed.size(); ++n) {
    const NearestRegion& region = regions[listed[n]];
    const float anchor_x = region.anchor[0], anchor_y = region.anchor[1],
                anchor_z = region.anchor[2];
    float farthest[planes];
    for (std::size_t p = 0; p < planes; ++p) {
      farthest[p] = region.offset[p] +
                    (std::abs(region.x[p]) * boxes.half_x + std::abs(region.y[p]) * boxes.half_y +
                     std::abs(region.z[p]) * boxes.half_z);
    }
    std::uint32_t bits = 0;
#pragma GCC unroll 1
    for (std::uint32_t l = 0; l < lanes; ++l) {
      const float x = boxes.x[l] - anchor_x, y = boxes.y[l] - anchor_y, z = boxes.z[l] - anchor_z;
      float most = 0;
      for (std::size_t p = 0; p < planes; ++p) {
        const float in_front = region.x[p] * x + region.y[p] * y + region.z[p] * z - farthest[p];
        most = in_front > most ? in_front : most;
      }
      bits |= most > 0 ? 0u : 1u << l;
    }
    touched[n] = static_cast<std::uint8_t>(bits);
  }
}

// The voxels of one of a cell's four layers, seen from the middle of the cell.
constexpr std::size_t layer = 16;
constexpr float offset_x[layer] = {-1.5f, -.5f, .5f, 1.5f, -1.5f, -.5f, .5f, 1.5f,
                                   -1.5f, -.5f, .5f, 1.5f, -1.5f, -.5f, .5f, 1.5f};
constexpr float offset_y[layer] = {-1.5f, -1.5f, -1.5f, -1.5f, -.5f, -.5f, -.5f, -.5f,
                                   .5f,   .5f,   .5f,   .5f,   1.5f, 1.5f, 1.5f, 1.5f};
constexpr float offset_z[4] = {-1.5f, -.5f, .5f, 1.5f};

// Each lowers the squared distances of a cell to those of a feature, where it is in reach; (x,y,z)
// is the middle of the cell from the region's anchor. They must become part of measure_cell() to be
// compiled for its instruction sets.

/// `sides` is 3, or 5 for a sliver.
template <std::size_t sides>
[[gnu::always_inline]] inline void lower_to_face(const NearestRegion& region, float x, float y,
                                                 float z, float* squared) {
  const float n_x = region.direction[0], n_y = region.direction[1], n_z = region.direction[2];
  float in_front[sides][layer], away[layer];  // of the sides, and of the face's plane
  for (std::size_t s = 0; s < sides; ++s) {
    const float s_x = region.x[s], s_y = region.y[s];
    const float middle = s_x * x + s_y * y + region.z[s] * z - region.offset[s];
    for (std::size_t l = 0; l < layer; ++l) {
      in_front[s][l] = middle + s_x * offset_x[l] + s_y * offset_y[l];
    }
  }
  const float middle =
      n_x * (x - region.point[0]) + n_y * (y - region.point[1]) + n_z * (z - region.point[2]);
  for (std::size_t l = 0; l < layer; ++l) away[l] = middle + n_x * offset_x[l] + n_y * offset_y[l];
  for (std::size_t k = 0; k < 4; ++k) {
    const float up = offset_z[k] * n_z;
    float* const of_layer = squared + k * layer;
    for (std::size_t l = 0; l < layer; ++l) {
      float most = in_front[0][l] + offset_z[k] * region.z[0];
      for (std::size_t s = 1; s < sides; ++s) {
        const float of_side = in_front[s][l] + offset_z[k] * region.z[s];
        most = most > of_side ? most : of_side;
      }
      const float d = away[l] + up;
      const float square = most > 0 ? std::numeric_limits<float>::infinity() : d * d;
      of_layer[l] = square < of_layer[l] ? square : of_layer[l];
    }
  }
}

[[gnu::always_inline]] inline void lower_to_edge(const NearestRegion& region, float x, float y,
                                                 float z, float* squared) {
  const float d_x = region.direction[0], d_y = region.direction[1], d_z = region.direction[2];
  const float start_x = x - region.point[0], start_y = y - region.point[1],
              start_z = z - region.point[2];
  // Measured from the edge's point nearest to the middle, so that squares stay small.
  const float foot =
      std::min(std::max(d_x * start_x + d_y * start_y + d_z * start_z, 0.0f), region.length);
  const float foot_x = start_x - foot * d_x, foot_y = start_y - foot * d_y,
              foot_z = start_z - foot * d_z;
  const float least = -foot, most = region.length - foot;
  float square_xy[layer], along_xy[layer];
  for (std::size_t l = 0; l < layer; ++l) {
    const float p_x = foot_x + offset_x[l], p_y = foot_y + offset_y[l];
    square_xy[l] = p_x * p_x + p_y * p_y;
    along_xy[l] = d_x * p_x + d_y * p_y;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const float p_z = foot_z + offset_z[k];
    const float square_z = p_z * p_z, along_z = d_z * p_z;
    float* const of_layer = squared + k * layer;
    for (std::size_t l = 0; l < layer; ++l) {
      const float along = along_xy[l] + along_z;
      const float ahead = along > least ? along : least;
      const float nearest = ahead < most ? ahead : most;
      // |p - nearest * d|²
      const float square = (square_xy[l] + square_z) - nearest * (along + along - nearest);
      of_layer[l] = square < of_layer[l] ? square : of_layer[l];
    }
  }
}

[[gnu::always_inline]] inline void lower_to_vertex(const NearestRegion& region, float x, float y,
                                                   float z, float* squared) {
  float square_xy[layer];
  for (std::size_t l = 0; l < layer; ++l) {
    const float p_x = x - region.point[0] + offset_x[l], p_y = y - region.point[1] + offset_y[l];
    square_xy[l] = p_x * p_x + p_y * p_y;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const float p_z = z - region.point[2] + offset_z[k];
    const float square_z = p_z * p_z;
    float* const of_layer = squared + k * layer;
    for (std::size_t l = 0; l < layer; ++l) {
      const float square = square_xy[l] + square_z;
      of_layer[l] = square < of_layer[l] ? square : of_layer[l];
    }
  }
}

}  // namespace

void EightLists::fill(std::span<const NearestRegion> regions, std::span<const std::uint32_t> listed,
                      const EightBoxes& boxes) {
  // One place more in each part: where a region that does not touch is written, to be overwritten.
  const std::size_t stride = stride_ = listed.size() + 1;
  if (of_boxes_.size() < 8 * stride) of_boxes_.resize(8 * stride);
  if (touched_.size() < listed.size()) touched_.resize(listed.size());
  find_touched(regions.data(), listed, boxes, touched_.data());
  std::uint32_t* const of_boxes = of_boxes_.data();
  std::array<std::size_t, 8> counts{};
  for (std::size_t n = 0; n < listed.size(); ++n) {
    const std::uint32_t region = listed[n];
    const std::uint32_t touched = touched_[n];
    for (std::size_t box = 0; box < 8; ++box) {
      of_boxes[box * stride + counts[box]] = region;
      counts[box] += touched >> box & 1;
    }
  }
  counts_ = counts;
}

VICINITY_WIDEST_VECTORS
void measure_cell(std::span<const NearestRegion> regions, std::span<const std::uint32_t> listed,
                  float middle_x, float middle_y, float middle_z, CellDistances& distances) {
  alignas(64) float squared[cell_voxels];  // not known to any other pointer
  for (float& square : squared) square = std::numeric_limits<float>::infinity();
  float error = 0;
  for (const std::uint32_t n : listed) {
    const NearestRegion& region = regions[n];
    error = std::max(error, region.error);
    const float x = middle_x - region.anchor[0], y = middle_y - region.anchor[1],
                z = middle_z - region.anchor[2];
    switch (region.kind) {
      case FeatureKind::face:
        lower_to_face<3>(region, x, y, z, squared);
        break;
      case FeatureKind::sliver:
        lower_to_face<5>(region, x, y, z, squared);
        break;
      case FeatureKind::edge:
        lower_to_edge(region, x, y, z, squared);
        break;
      case FeatureKind::vertex:
        lower_to_vertex(region, x, y, z, squared);
        break;
    }
  }
  std::copy_n(squared, cell_voxels, distances.squared);
  distances.error = error;
}

VICINITY_WIDEST_VECTORS
void round_cell(const CellDistances& distances, const Rounding& rounding, RoundedCell& rounded) {
  const Rounding r = rounding;  // no store below can change it
  // Both ends of a distance are off by as much as positions are. Squares are off by rounding: by
  // 6e-7 of the square of the longest side, which is a distance and a cell and a half, and
  // distances by that over twice the distance. Below 0.005, all that matters is that no step is
  // reached. A plane's distance may have been taken so far from its triangle, see blunt: ten times
  // what regions are widened by.
  const float error = 2 * distances.error;
  const float beside = 20 * (1e-4f + distances.error);
  std::int32_t steps[cell_voxels], ranks[cell_voxels], differences[cell_voxels];
  for (std::size_t v = 0; v < cell_voxels; ++v) {
    const float square = distances.squared[v];
    const float root = std::sqrt(square > 0 ? square : 0.0f);
    const float d = root < r.farthest ? root : r.farthest;
    const float of_squares = 3e-7f * (d + 12) + 1.08e-5f / (d > 0.005f ? d : 0.005f);
    const float off = error + of_squares + beside * beside / (d > beside ? d : beside);
    const float low = d > off ? d - off : 0.0f, high = d + off;
    const float low_s = low > r.zero ? low - r.zero : 0.0f;
    const float high_s = high > r.zero ? high - r.zero : 0.0f;
    steps[v] = static_cast<std::int32_t>(high * r.steps_per_voxel);
    ranks[v] = static_cast<std::int32_t>(high_s * r.ranks_per_voxel);
    differences[v] = (steps[v] ^ static_cast<std::int32_t>(low * r.steps_per_voxel)) |
                     (ranks[v] ^ static_cast<std::int32_t>(low_s * r.ranks_per_voxel));
  }
  std::uint64_t unsure = 0;
  for (std::size_t v = 0; v < cell_voxels; ++v) {
    rounded.steps[v] =
        static_cast<std::uint16_t>(steps[v] < r.most_steps ? steps[v] : r.most_steps);
    rounded.ranks[v] = static_cast<std::uint8_t>(ranks[v] < r.no_rank ? ranks[v] : r.no_rank);
    unsure |= std::uint64_t{differences[v] != 0} << v;
  }
  rounded.unsure = unsure;
}

}  // namespace vicinity
