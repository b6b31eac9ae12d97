// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Which way the nearest surface lies, read from the field alone.
#pragma once

#include "vicinity/geometry/vec3.h"
#include "vicinity/viscosity/field.h"

namespace vicinity {

/// Unit vector in W from p_W towards the nearest surface, shape (3,).
///
/// Where distance is kept: down the gradient of the interpolated distance, over one voxel to each
/// side. Elsewhere: down the gradient of the ranks around the voxel (boundary and inner 0, rank n
/// in the middle of its layer, empty beyond the last), from 52 voxels m and 2m away in 26
/// directions. Around a smooth object that is 3 degrees off in the mean where m is 4, 4 where m is
/// 2 and 6 where m is 1; the distance is off by less than a fifth of a degree.
///
/// Zero where no direction is defined: in empty space, deep inside an object, on or very near a
/// thin plate, half-way between two surfaces, on the axis of a hole. Real-time: 60 lookups at most,
/// no allocation.
Vec3 towards_surface(const ViscosityField& field, const Vec3& p_W) noexcept;

}  // namespace vicinity
