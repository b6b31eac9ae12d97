// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Drag on a point robot that passes an object: figures 5 and 22 to 24.
#pragma once

#include <vector>

#include "reproduce/item.h"
#include "reproduce/pass.h"

namespace vicinity::report {

/// Fig. 5: towards the side of the circular cylinder, slow first, then fast.
std::vector<Pass> approach_slow_and_fast(const ViscosityField& field,
                                         const ViscosityField& distances);
/// @param at_rest  drag on R standing in rank 1 [N]
std::vector<Check> check_fig5(const std::vector<Pass>& slow_and_fast, double at_rest);
Outcome fig5(Workshop& workshop);

/// Fig. 22: the six tracks by the cone, lowest first.
std::vector<Pass> six_tracks(const ViscosityField& field, const ViscosityField& distances);
std::vector<Check> check_fig22(const std::vector<Pass>& tracks);
Outcome fig22(Workshop& workshop);

/// Fig. 23: past and through the complex cylinder at y = 20, 50 and 80.
std::vector<Pass> three_tracks(const ViscosityField& field, const ViscosityField& distances);
/// @param text,caption  the same tracks with the coding that the text and that the caption names
std::vector<Check> check_fig23(const std::vector<Pass>& text, const std::vector<Pass>& caption);
Outcome fig23(Workshop& workshop);

/// Fig. 24: one track by the cone at several speeds, slowest first.
std::vector<Pass> same_track_at_speeds(const ViscosityField& field,
                                       const ViscosityField& distances);
std::vector<Check> check_fig24(const std::vector<Pass>& by_speed);
Outcome fig24(Workshop& workshop);

}  // namespace vicinity::report
