// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A point robot R on a straight pass through the layers, and what can be asked of every pass.
#pragma once

#include <string>
#include <vector>

#include "picture/chart.h"
#include "reproduce/verdict.h"
#include "vicinity/drag/trace.h"
#include "vicinity/layers/shaping_element.h"

namespace vicinity::report {

/// R's surface [m²] and speed [m/s] where the paper says unit: drag in newtons is then the number
/// of the viscosity.
inline constexpr double unit_area = 1, unit_speed = 1;

struct Pass {
  std::string name;
  Vec3 from_vox = Vec3::Zero(), to_vox = Vec3::Zero();
  double speed = unit_speed;  ///< [m/s]
  std::vector<TraceSample> samples = {};
  /// True distance between the surface and the centre of the voxel each sample is in, in voxels;
  /// below zero: inside, or too far to be known.
  std::vector<double> distance_vox = {};

  /// Way of a sample along the pass, in voxels.
  double way_vox(const TraceSample& sample) const;
  /// Largest drag on the way [N].
  double peak() const;
};

/// Moves R along the pass, five samples a voxel.
/// @param distances  of Workshop::distances(), over the same voxels
Pass walk(Pass pass, const ViscosityField& field, const ViscosityField& distances,
          const MemoryWeights& memory = {});

/// Drag over way, for a chart.
cli::Series drag_series(const Pass& pass);

/// The viscosity felt tells the distance: a voxel that feels as rank n lies in layer n of the true
/// distance, as far as voxels can tell.
/// @param coding  what rank n should feel like, and
/// @param m       how thick its layer should be, in voxels
Check viscosity_tells_distance(const std::vector<Pass>& passes, const Coding& coding, int m);

/// F = -mu_e S v at every sample: against the motion, in proportion to it.
Check force_is_drag(const std::vector<Pass>& passes);

/// "32, 25, 20".
std::string listed(const std::vector<double>& values, const char* format = "{:.4g}");

}  // namespace vicinity::report
