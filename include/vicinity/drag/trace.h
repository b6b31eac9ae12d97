// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A point on a straight track, and the drag it feels on the way (fig. 22-24, 26-29).
#pragma once

#include <span>
#include <vector>

#include "vicinity/drag/drag.h"
#include "vicinity/drag/moving_point.h"
#include "vicinity/drag/viscosity_memory.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/viscosity/field.h"

namespace vicinity {

/// A straight track at constant speed, sampled at a constant rate.
struct Track {
  Vec3 from_W = Vec3::Zero(), to_W = Vec3::Zero();  ///< shape (3,) [m]
  double speed = 0.1;                               ///< [m/s]
  double rate = 1000;                               ///< samples per second [Hz]
};

/// How a point feels the field.
struct DragOptions {
  double area = 1;            ///< S [m²]; 1 is the paper's point robot
  MemoryWeights memory = {};  ///< of eq. (6-7)
  DragDirection direction = DragDirection::all;
  Traversal traversal = Traversal::swept;
};

/// One instant of a track.
struct TraceSample {
  double t = 0;                 ///< [s]
  Vec3 p_WR = Vec3::Zero();     ///< [m]
  VoxelRecord record;           ///< of the voxel it is in
  double mu = 0;                ///< there [N·s/m³]
  double mu_e = 0;              ///< after the memory [N·s/m³]
  Vec3 force_W = Vec3::Zero();  ///< drag on the point [N]
};

/// Moves a point along a track: one sample every 1/rate seconds from t = 0, and one at the end. The
/// velocity is that of the track at every sample, the ends included; on a track without length the
/// point is at rest, and there is one sample.
/// Errors: throws Error for ends that are not finite, a speed or rate that is not positive, a
/// negative area, and a track of more than ten million samples.
std::vector<TraceSample> trace(const ViscosityField& field, const Track& track,
                               const DragOptions& options = {});

/// The same along a path of one's own.
///
/// @param path_W  positions, one every 1/rate seconds, shape (N, 3) [m]
/// @param rate    [Hz]
/// @return        one sample for each position. The velocity is the difference from the position
///                before; at the first one the point is at rest.
/// Errors: throws Error for a position that is not finite, a rate that is not positive, and a
/// negative area.
std::vector<TraceSample> trace(const ViscosityField& field, std::span<const Vec3> path_W,
                               double rate = Track().rate, const DragOptions& options = {});

}  // namespace vicinity
