// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>

namespace vicinity::cli {

/// 1234567 -> "1,234,567".
std::string grouped(std::uint64_t n);

/// Bytes with a fitting unit: "812 B", "8.4 MB" (powers of 1000).
std::string bytes(std::uint64_t n);

/// Seconds with three digits that matter: "0.004 s", "1.24 s", "75 s".
std::string seconds(double s);

}  // namespace vicinity::cli
