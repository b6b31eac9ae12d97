// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// SHA-256 (FIPS 180-4), for a few kilobytes.
#pragma once

#include <string>
#include <string_view>

namespace vicinity::ros2 {

/// 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view text);

}  // namespace vicinity::ros2
