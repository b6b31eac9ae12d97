// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A joint log of the demo's arm, as a controller would have written it.
#pragma once

#include <filesystem>

namespace vicinity::cli {

/// The arm swings round to the vessel, reaches between the risers to its flange, waits there, and
/// goes back at half the speed: CSV with t and the joints' names, 100 lines a second.
/// Errors: throws Error where the file cannot be written.
void write_arm_motion(const std::filesystem::path& path);

}  // namespace vicinity::cli
