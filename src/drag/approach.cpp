// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/approach.h"

#include <cmath>

namespace vicinity {
namespace {

// Both gradients are about 1 in length where one surface is nearest. A short one is what is left
// where two surfaces pull against each other, or what rounding left of nothing; to trust it would
// free a motion that may be closing in.
constexpr double least_distance_gradient = 0.5;
constexpr double least_rank_gradient = 0.25;

// Distance from the surface that a voxel's record stands for, in voxels; empty space is just
// beyond the layers of `nearest`. Ranks of different objects compare by their layers' widths.
double layer_depth_vox(const ViscosityField& field, const VoxelIndex& voxel,
                       const FieldObject& nearest) noexcept {
  const VoxelRecord& record = field.records()[field.code_at(voxel)];
  switch (record.kind) {
    case VoxelKind::empty:
      return (nearest.q + 0.5) * nearest.m;
    case VoxelKind::neighbour:
      return (record.rank - 0.5) * field.objects()[record.object].m;
    case VoxelKind::inner:
    case VoxelKind::boundary:
      break;
  }
  return 0;
}

// Gradient of the layers' depth: 1 in length amid the layers of a smooth surface, by a half less
// where the surface or the last layer is near.
//
// Ranks are steps m voxels wide. Two shells of 26 voxels, m and 2m away, blur them more than one:
// one at m has almost twice the error, one at 2m sees the layers on the other side of a thin plate
// and loses its direction there.
Vec3 away_by_ranks(const ViscosityField& field, const VoxelIndex& voxel,
                   const FieldObject& nearest) noexcept {
  Vec3 away = Vec3::Zero();
  double lengths = 0;
  for (const int radius : {nearest.m, 2 * nearest.m}) {
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          const int axes = i * i + j * j + k * k;
          if (axes == 0) continue;
          const auto reach = static_cast<int>(std::lround(radius / std::sqrt(axes)));
          const Vec3 offset(i * reach, j * reach, k * reach);
          const double length = reach * std::sqrt(axes);
          const VoxelIndex there{voxel.i + i * reach, voxel.j + j * reach, voxel.k + k * reach};
          away += layer_depth_vox(field, there, nearest) / length * offset;
          lengths += length;
        }
      }
    }
  }
  // Least squares, each offset weighed by the inverse of its length: they are symmetric, so that
  // the sum of their weighed outer products is the identity times a third of its trace.
  return away / (lengths / 3);
}

// Gradient of the kept distance, one-sided where the layers end.
Vec3 away_by_distance(const ViscosityField& field, const Vec3& p_W, double here) noexcept {
  const double h = field.workspace().voxel_size;
  Vec3 away = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = h * Vec3::Unit(axis);
    const double before = field.at(p_W - step).distance_m;
    const double after = field.at(p_W + step).distance_m;
    if (before >= 0 && after >= 0) {
      away[axis] = (after - before) / (2 * h);
    } else if (after >= 0) {
      away[axis] = (after - here) / h;
    } else if (before >= 0) {
      away[axis] = (here - before) / h;
    }
  }
  return away;
}

}  // namespace

Vec3 towards_surface(const ViscosityField& field, const Vec3& p_W) noexcept {
  const FieldSample sample = field.at(p_W);
  if (sample.record.kind == VoxelKind::empty) return Vec3::Zero();
  if (sample.distance_m >= 0) {
    const Vec3 away = away_by_distance(field, p_W, sample.distance_m);
    if (away.norm() > least_distance_gradient) return -away.normalized();
  }
  const Vec3 away =
      away_by_ranks(field, field.workspace().index_of(p_W), field.objects()[sample.record.object]);
  return away.norm() > least_rank_gradient ? Vec3(-away.normalized()) : Vec3::Zero();
}

}  // namespace vicinity
