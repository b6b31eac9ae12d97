// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The names of the memories that every test of moving points goes through.
#pragma once

#include <array>

namespace vicinity {

inline constexpr std::array presets{"none", "sustained", "fading", "short", "rising"};

}  // namespace vicinity
