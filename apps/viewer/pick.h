// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What is at a point, in the words of PICK.
#pragma once

#include <nlohmann/json.hpp>

#include "vicinity/geometry/vec3.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::viewer {

/// The keys of `vicinity query --json`, with the voxel, its code and how near the object can be.
/// @param p_W  finite [m]
nlohmann::ordered_json pick_json(const ViscosityField& field, const Vec3& p_W);

}  // namespace vicinity::viewer
