// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A body point on its way through the field, and what it remembers of it.
#pragma once

#include "vicinity/drag/recorded_path.h"
#include "vicinity/drag/viscosity_memory.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/viscosity/field.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// One point's mutable part: the field and the weights are shared, this is its own.
class MovingPoint {
 public:
  /// Moves the point to p_W and returns its effective viscosity mu_e [N·s/m³]. The first call
  /// starts the memory with the voxel it finds (paper: the whole buffer holds the first viscosity).
  ///
  /// Several voxels may be entered in one call: see record_path().
  ///
  /// Outside the workspace is empty space. A position that is not finite leaves the point where it
  /// is. Always use one point with the same grid; reset() it before another.
  /// Real-time: no allocation; time grows with the voxels on the path within the workspace, so that
  /// the caller decides which jump is too long to be a motion.
  double advance(const ViscosityField& field, const MemoryWeights& weights, Traversal traversal,
                 const Vec3& p_W) noexcept;

  /// Unit vector towards the surface that the point feels (approach.h). In empty space, where it
  /// only remembers its viscosity, it remembers the direction too, so that a retreat stays free to
  /// the end. Zero where not defined.
  /// Real-time: as vicinity::towards_surface().
  Vec3 towards_surface(const ViscosityField& field) noexcept;

  /// Forgets everything: the next advance() starts anew.
  void reset() noexcept { started_ = false; }

 private:
  ViscosityMemory memory_;
  Vec3 p_W_ = Vec3::Zero();
  Vec3 towards_W_ = Vec3::Zero();
  VoxelIndex voxel_;  // the one that was recorded last
  bool started_ = false;
};

}  // namespace vicinity
