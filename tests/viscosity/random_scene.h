// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Small scenes of a few overlapping solids, by seed.
#pragma once

#include <random>

#include "vicinity/viscosity/scene.h"

namespace vicinity::test {

/// Voxel size of random scenes: a power of two, and all vertices multiples of 2^-20 m, so that
/// moving a scene by whole voxels loses no bit.
inline constexpr double random_scene_voxel = 1.0 / 64;

/// @param extent_vox  objects have their centres within a cube of this size from the origin
Scene random_scene(std::mt19937& random, int objects, double extent_vox);

/// A closed solid in any pose, about 4 to 24 voxels across.
TriangleMesh random_solid(std::mt19937& random, const Vec3& centre);

}  // namespace vicinity::test
