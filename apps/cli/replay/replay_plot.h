// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A replay as a picture: torques, force and distance over time, what was felt, and the status.
#pragma once

#include <filesystem>

#include "replay/summary.h"

namespace vicinity::cli {

/// Errors: throws Error for an extension other than .svg and .png, and where the file cannot be
/// written.
void plot_replay(const ReplayOutcome& outcome, const std::filesystem::path& field,
                 const std::filesystem::path& trajectory, const std::filesystem::path& picture);

}  // namespace vicinity::cli
