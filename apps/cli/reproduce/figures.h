// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Figures of the report, drawn into the workshop.
#pragma once

#include <optional>
#include <string>

#include "picture/chart.h"
#include "reproduce/item.h"

namespace vicinity::report {

/// A section through the layers.
/// @param axis    0, 1, 2: across x, y, z
/// @param at_vox  index of the layer of voxels
/// @param part    only this, in voxels
Figure section(const Workshop& workshop, const std::string& file, const ViscosityField& field,
               int axis, int at_vox, const std::string& title, const std::string& says,
               const std::optional<Box>& part = {});

Figure chart(const Workshop& workshop, const std::string& file, const cli::Chart& drawing,
             const std::string& title, const std::string& says);

}  // namespace vicinity::report
