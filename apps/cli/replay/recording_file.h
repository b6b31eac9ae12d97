// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A recording as a file that other programs read.
#pragma once

#include <filesystem>

#include "replay/arm.h"
#include "replay/recording.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::cli {

/// Writes t, tau_<joint>..., fx,fy,fz,mx,my,mz, master_force, status, reason_link, reason_object,
/// reason_rank, reason_distance_mm, q_<joint>... [s, N·m, N, N·m, N, mm, rad], one line for each
/// tick: CSV, or JSON lines where the name ends in .jsonl. A reason is empty (null) where nothing
/// is felt; its object, rank and distance are, where the point has left and only remembers. No
/// distance is known in boundary and inner voxels but zero.
///
/// A name that ends in .mcap gives an MCAP file of ROS 2 messages: see McapRecording.
///
/// @param t_start  time of the first tick, in the log's own count [s]
/// Errors: throws Error where the file cannot be written; nothing is left behind then. Of an MCAP
/// file check_times() first.
void write_recording(const Recording& recording, const Arm& arm, const ViscosityField& field,
                     double t_start, const std::filesystem::path& path);

/// Whether its name says that it is an MCAP file.
bool is_mcap(const std::filesystem::path& path);

}  // namespace vicinity::cli
