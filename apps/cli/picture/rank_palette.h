// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Colours of voxels: the nearer to a surface, the darker.
#pragma once

#include "picture/canvas.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::cli {

/// Colour of rank n of q, 1 <= n <= q: from deep red-violet at the surface to pale yellow in the
/// last layer. Lightness rises in equal steps, as the eye sees them (OKLab), so that ranks can be
/// told apart by a colour-blind person and in grey print.
Colour rank_colour(int n, int q);

inline constexpr Colour boundary_colour{0.08, 0.08, 0.09};
inline constexpr Colour inner_colour{0.72, 0.72, 0.73}, inner_hatch_colour{0.55, 0.55, 0.57};

/// Colour of a voxel; empty space is white. @param q  ranks of the whole field
Colour colour_of(const VoxelRecord& record, int q);

/// The largest q of all objects. Ranks of all of them share one palette, so that a rank looks the
/// same everywhere.
int most_ranks(const ViscosityField& field);

}  // namespace vicinity::cli
