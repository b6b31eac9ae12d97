// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity bridge: a program of its own, vicinity-bridge, so that nobody else needs DDS.
#pragma once

namespace vicinity::cli {

inline constexpr const char* bridge_does =
    "Feel for an arm in ROS 2: joint states in over DDS, wrench and reason out";

/// Becomes vicinity-bridge, the one beside this program or else the first on PATH: the same
/// process, so that signals, standard input and exit code are its own.
/// @param arguments  what follows `vicinity bridge`, up to a null pointer
/// Errors: throws Error where there is none, or it cannot be run.
[[noreturn]] void become_bridge(char** arguments);

}  // namespace vicinity::cli
